#include "ros/simulation/demo_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "laparoscope_servo/geometry/sl3.h"

namespace laparoscope_servo {
namespace {

const geometry::Rectangle kRoi{100.0, 80.0, 101.0, 51.0};

Homography message(const Eigen::Matrix3d& g) {
  Homography result;
  const Eigen::Matrix3d normalised = geometry::normaliseDeterminant(g);
  for (int k = 0; k < 9; ++k) result.g[static_cast<std::size_t>(k)] = normalised(k / 3, k % 3);
  return result;
}

TEST(ViewError, IsZeroAtTheReference) {
  const ViewError error = viewError(message(Eigen::Matrix3d::Identity()), kRoi);
  EXPECT_NEAR(error.centre, 0.0, 1e-12);
  EXPECT_NEAR(error.scale, 0.0, 1e-12);
}

TEST(ViewError, MeasuresShiftOfTheCentreAndChangeOfSize) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g(0, 2) = 3.0;
  g(1, 2) = -4.0;
  EXPECT_NEAR(viewError(message(g), kRoi).centre, 5.0, 1e-9);
  EXPECT_NEAR(viewError(message(g), kRoi).scale, 0.0, 1e-12);
  // Larger and smaller count alike, about the centre.
  for (const double factor : {1.25, 0.75}) {
    g << factor, 0.0, (1.0 - factor) * 150.0, 0.0, factor, (1.0 - factor) * 105.0, 0.0, 0.0, 1.0;
    EXPECT_NEAR(viewError(message(g), kRoi).centre, 0.0, 1e-9);
    EXPECT_NEAR(viewError(message(g), kRoi).scale, 0.25, 1e-9);
  }
}

TEST(PoseError, MeasuresAngleAndDepthAboutTheInsertionPoint) {
  const Eigen::Vector3d insertion_point(0.1, 0.2, 0.3);
  const Eigen::Isometry3d base_T_shaft =
      Eigen::Translation3d(insertion_point) * Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX());
  const Eigen::Isometry3d reference = base_T_shaft * Eigen::Translation3d(0.0, 0.0, 0.1);
  const Eigen::Isometry3d moved =
      base_T_shaft * Eigen::AngleAxisd(0.15, Eigen::Vector3d::UnitY()) * Eigen::Translation3d(0.0, 0.0, 0.12);
  const PoseError error = poseError(reference, moved, insertion_point);
  EXPECT_NEAR(error.angle, 0.15, 1e-12);
  EXPECT_NEAR(error.depth, 0.02, 1e-12);
  EXPECT_NEAR(error.lateral, 0.12 * std::sin(0.15), 1e-12);
  // Spin about the shaft is none of these.
  const PoseError spun =
      poseError(reference, reference * Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()), insertion_point);
  EXPECT_NEAR(spun.angle + std::abs(spun.depth) + spun.lateral, 0.0, 1e-9);
}

TEST(Settling, IsSettledAfterTheHoldTimeInside) {
  Settling settling(2.0, 0.02, 1.0);
  settling.update(0.0, true, {5.0, 0.0});
  settling.update(1.0, true, {1.0, 0.01});
  EXPECT_EQ(settling.since(), 1.0);
  settling.update(1.9, true, {1.0, 0.01});
  EXPECT_FALSE(settling.settled());
  settling.update(2.0, true, {1.0, 0.01});
  EXPECT_TRUE(settling.settled());
  EXPECT_EQ(settling.since(), 1.0);
}

TEST(Settling, StartsAnewWhenTheErrorLeavesOrTrackingEnds) {
  for (const auto& [tracking, error] : {std::pair<bool, ViewError>{true, {2.1, 0.0}},
                                        {true, {0.0, 0.03}},
                                        {false, {0.0, 0.0}},
                                        {true, {std::nan(""), 0.0}},
                                        {true, {0.0, std::nan("")}}}) {
    Settling settling(2.0, 0.02, 1.0);
    settling.update(0.0, true, {0.0, 0.0});
    settling.update(1.5, true, {0.0, 0.0});
    EXPECT_TRUE(settling.settled());
    settling.update(1.6, tracking, error);
    EXPECT_FALSE(settling.settled());
    settling.update(1.7, true, {0.0, 0.0});
    EXPECT_EQ(settling.since(), 1.7);
    settling.update(2.6, true, {0.0, 0.0});
    EXPECT_FALSE(settling.settled());
  }
}

TEST(ToJson, WritesUnitsThatItsNamesSayAndEscapesText) {
  DemoSummary summary;
  summary.reason = "a \"quoted\" \\ line\nbreak";
  summary.start_truth.angle = M_PI / 18.0;
  summary.final_truth.depth = 0.0015;
  summary.final_error_px = std::numeric_limits<double>::quiet_NaN();
  const std::string json = toJson(summary);
  for (const char* part :
       {"\"converged\": false", R"("reason": "a \"quoted\" \\ line break")", "\"start_angle_deg\": 10,",
        "\"final_depth_mm\": 1.5", "\"final_error_px\": null", "\"instrument_crossed\": false"}) {
    EXPECT_NE(json.find(part), std::string::npos) << part << " in\n" << json;
  }
}

}  // namespace
}  // namespace laparoscope_servo
