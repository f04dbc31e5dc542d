#include "laparoscope_servo/sim/patient.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace laparoscope_servo::sim {
namespace {

const Eigen::Vector3d kTarget(0.0, 0.0, 0.08);

TEST(Patient, LiesStillByDefault) {
  const Patient patient(PatientConfig(), kTarget);
  for (const double t : {0.0, 1.0, 1000.0}) {
    EXPECT_TRUE(patient.tissueMotion(t).isApprox(Eigen::Isometry3d::Identity(), 1e-15));
    EXPECT_EQ(patient.trocarOffset(t), Eigen::Vector3d::Zero());
  }
}

TEST(Patient, BreathesWithItsPeriodAndAmplitude) {
  PatientConfig config;
  config.breathing.frequency = 0.2;
  config.breathing.second_harmonic = 0.3;
  config.breathing.tissue = {0.0, 0.005, 0.001};
  config.breathing.trocar = {0.003, 0.0, 0.0};
  const Patient patient(config, kTarget);
  double highest = 0.0;
  for (double t = 0.0; t < 20.0; t += 0.01) {
    const Eigen::Vector3d now = patient.tissueMotion(t).translation();
    EXPECT_NEAR((now - patient.tissueMotion(t + 5.0).translation()).norm(), 0.0, 1e-12);
    EXPECT_NEAR(now.z(), 0.2 * now.y(), 1e-15);
    EXPECT_NEAR(patient.trocarOffset(t).x(), 0.6 * now.y(), 1e-15);
    highest = std::max(highest, now.y());
  }
  EXPECT_GT(highest, 0.005);
  EXPECT_LE(highest, 0.0065);
}

TEST(Patient, HoldsItsBreathWhereItIs) {
  PatientConfig config;
  config.breathing.tissue = {0.0, 0.005, 0.0};
  config.breathing.start = 2.0;
  config.breathing.end = 3.5;
  const Patient patient(config, kTarget);
  EXPECT_EQ(patient.tissueMotion(1.9).translation().y(), 0.0);
  EXPECT_GT(patient.tissueMotion(3.0).translation().y(), 0.004);
  EXPECT_EQ(patient.tissueMotion(3.5).translation(), patient.tissueMotion(9.0).translation());
}

TEST(Patient, DriftsAndIsPulled) {
  PatientConfig config;
  config.drift = {0.001, 0.0, 0.0};
  config.drift_end = 4.0;
  config.jump = {0.0, 0.01, 0.0};
  config.jump_time = 2.0;
  const Patient patient(config, kTarget);
  EXPECT_NEAR((patient.tissueMotion(1.0).translation() - Eigen::Vector3d(0.001, 0.0, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((patient.tissueMotion(2.0).translation() - Eigen::Vector3d(0.002, 0.01, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((patient.tissueMotion(9.0).translation() - Eigen::Vector3d(0.004, 0.01, 0.0)).norm(), 0.0, 1e-15);
}

TEST(Patient, IsPulledAgainAndAgainSmoothly) {
  PatientConfig config;
  config.pull = {0.02, 0.5, 4.0};
  const Patient patient(config, kTarget);
  const auto at = [&patient](double t) { return Eigen::Vector3d(patient.tissueMotion(t).translation()); };
  EXPECT_EQ(at(3.9), Eigen::Vector3d::Zero());
  for (double t = 0.0; t < 40.0; t += 0.01) {
    // The fastest that a raised cosine is between two places on the circle, and nearer or further by a third of it.
    EXPECT_LE((at(t + 0.01) - at(t)).norm(), 0.01 * 0.5 * M_PI / 0.5 * 0.02 * std::hypot(2.0, 2.0 / 3.0) + 1e-12);
    if (std::fmod(t, 4.0) > 0.5) {
      EXPECT_LT((at(t) - at(t - std::fmod(t, 4.0) + 3.99)).norm(), 1e-12);
    }
  }
  EXPECT_NEAR(at(4.6).head<2>().norm(), 0.02, 1e-12);
  EXPECT_GT((at(8.6) - at(4.6)).norm(), 0.02);
}

TEST(Patient, TiltsAboutTheTarget) {
  PatientConfig config;
  config.tilt = 0.4;
  config.tilt_frequency = 0.25;
  const Patient patient(config, kTarget);
  const Eigen::Isometry3d turned = patient.tissueMotion(1.0);
  EXPECT_NEAR((turned * kTarget - kTarget).norm(), 0.0, 1e-15);
  EXPECT_NEAR(Eigen::AngleAxisd(turned.linear()).angle(), 0.4, 1e-12);
}

TEST(Patient, NamesWhatIsWrong) {
  EXPECT_TRUE(validate(PatientConfig()).empty());
  PatientConfig config;
  config.breathing.frequency = 0.0;
  config.breathing.tissue = {0.0, 0.0};
  config.breathing.trocar = {0.0, 1.0, 0.0};
  config.drift = {0.0, 0.0, std::numeric_limits<double>::quiet_NaN()};
  config.tilt = -1.0;
  config.pull = {-0.1, 0.5, 0.4};
  const std::vector<std::string> errors = validate(config);
  ASSERT_EQ(errors.size(), 7u);
  EXPECT_EQ(errors[0].rfind("breathing/frequency = 0", 0), 0u);
  EXPECT_EQ(errors[1].rfind("breathing/tissue has 2 elements", 0), 0u);
  EXPECT_EQ(errors[2].rfind("breathing/trocar[1] = 1", 0), 0u);
  EXPECT_EQ(errors[3].rfind("pull/distance = -0.1", 0), 0u);
  EXPECT_EQ(errors[4].rfind("pull/period = 0.4", 0), 0u);
  EXPECT_EQ(errors[5].rfind("drift[2] = ", 0), 0u);
  EXPECT_EQ(errors[6].rfind("tilt = -1", 0), 0u);
}

}  // namespace
}  // namespace laparoscope_servo::sim
