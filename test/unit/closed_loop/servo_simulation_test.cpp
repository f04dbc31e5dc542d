// The closed loop: what the design promises of it, checked in simulation.
#include "laparoscope_servo/closed_loop/servo_simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace laparoscope_servo::closed_loop {
namespace {

SimulationSummary run(const ControllerSetup& controller, const SimulationConfig& config, double duration = 40.0,
                      unsigned seed = 1) {
  return summarise(simulate(controller, config, seed, duration), config);
}

SimulationConfig ideal() {
  SimulationConfig config;
  config.corner_noise = 0.0;
  config.robot.delay = 0.0;
  config.robot.dead_zone = {0.0, 0.0, 0.0, 0.0};
  return config;
}

// The paper's law with its gains, and nothing that came later but the dead zone's inverse.
ControllerSetup paper() {
  ControllerSetup controller;
  controller.control.law = servo::LawKind::kPaper;
  controller.control.predictor.enabled = false;
  return controller;
}

TEST(ServoSimulation, SettlesFromTenDegreesAndTwentyMillimetres) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const SimulationSummary summary = run(ControllerSetup(), SimulationConfig(), 40.0, seed);
    EXPECT_GT(summary.settling_time, 0.0) << seed;
    EXPECT_LT(summary.settling_time, 3.0) << seed;
    EXPECT_LT(summary.final_offset, 0.7);
    EXPECT_LT(summary.final_scale_error, 0.01);
    const SimulationSummary published = run(paper(), SimulationConfig(), 40.0, seed);
    EXPECT_GT(published.settling_time, 0.0) << seed;
    EXPECT_LT(published.settling_time, 16.0) << seed;  // the paper's time, on its robot
    EXPECT_LT(summary.settling_time, published.settling_time / 3.0);
  }
}

TEST(ServoSimulation, ObliqueOpticsSettleAlike) {
  SimulationConfig config;
  config.optics_angle = 0.5236;
  config.optics_roll = 0.7;
  config.start = {0.08, 0.08, 0.17, 0.01};
  const SimulationSummary summary = run(ControllerSetup(), config, 20.0);
  EXPECT_GT(summary.settling_time, 0.0);
  EXPECT_LT(summary.settling_time, 3.0);
  EXPECT_LT(summary.final_offset, 0.7);
  EXPECT_LE(summary.max_lateral_offset, 1e-9);
}

// 15 degrees in all, 40 degrees of spin and 25 mm; the image is so large that each of them sees the ROI.
TEST(ServoSimulation, LargeStartsConvergeWithoutLeavingTheImage) {
  SimulationConfig config;
  config.width = 1280.0;
  config.height = 960.0;
  config.camera = {400.0, 400.0, 639.5, 479.5};
  config.roi = {590.0, 430.0, 100.0, 100.0};
  for (const double sign : {1.0, -1.0}) {
    config.start = {sign * 0.2, -0.18, 0.7, sign * 0.025};
    const auto samples = simulate(ControllerSetup(), config, 1, 12.0);
    const SimulationSummary summary = summarise(samples, config, 1.0, 0.01);
    EXPECT_GT(summary.settling_time, 0.0);
    EXPECT_LT(summary.final_alpha, 0.5 * M_PI / 180.0);
    for (const SimulationSample& sample : samples) ASSERT_GE(sample.worst_corner, 0.0) << sample.t;
  }
}

TEST(ServoSimulation, ConvergesWithAWrongDelay) {
  for (const double delay : {0.08, 0.24}) {
    SimulationConfig config;
    config.robot.delay = delay;
    EXPECT_GT(run(ControllerSetup(), config, 40.0).settling_time, 0.0) << delay;
  }
}

// Tissue that slides: with feed-forward the target is kept, without it lags.
TEST(ServoSimulation, FollowsTissueThatSlides) {
  SimulationConfig config;
  config.patient.drift = {0.005, 0.0, 0.0};
  config.patient.drift_end = 8.0;
  ControllerSetup lagging;
  lagging.control.predictor.feed_forward = false;
  const auto rms = [&](const ControllerSetup& controller) {
    double sum = 0.0, count = 0.0;
    for (const SimulationSample& s : simulate(controller, config, 1, 8.0)) {
      if (s.t < 4.0) continue;
      sum += (Eigen::Vector2d(s.u, s.v) - config.roi.centre()).squaredNorm();
      count += 1.0;
    }
    return std::sqrt(sum / count);
  };
  EXPECT_LT(rms(ControllerSetup()), 1.0);
  EXPECT_GT(rms(lagging), 2.0);
}

// The task of the constraint: nothing that is executed moves the insertion point sideways.
TEST(ServoSimulation, DoesNotPushTheInsertionPoint) {
  const SimulationSummary summary = run(ControllerSetup(), SimulationConfig());
  EXPECT_LE(summary.max_lateral_speed, 1e-9);
  EXPECT_LE(summary.max_lateral_offset, 1e-9);
}

// The measure is one: with a wrong lever it shows what pushes the wall.
TEST(ServoSimulation, AWrongLeverShowsAtTheInsertionPoint) {
  SimulationConfig config = ideal();
  config.believed_depth_factor = 1.2;
  const SimulationSummary summary = run(ControllerSetup(), config, 10.0);
  EXPECT_GT(summary.max_lateral_speed, 1e-4);
  EXPECT_GT(summary.max_lateral_offset, 1e-4);
}

// The paper's gains stop where the dead zone begins; the inverse takes them through it.
TEST(ServoSimulation, DeadZoneNeedsItsInverse) {
  ControllerSetup without = paper();
  without.control.dead_zone.inverse = false;
  EXPECT_LT(run(without, SimulationConfig()).settling_time, 0.0);
  EXPECT_GT(run(without, SimulationConfig()).final_offset, 4.0);
  EXPECT_GT(run(paper(), SimulationConfig()).settling_time, 0.0);
}

// Whatever kind the robot's dead zone is of, and also when it is smaller than believed: no limit cycle, the arm rests.
TEST(ServoSimulation, RestsWhenItHasArrived) {
  for (const char* kind : {"subtract", "threshold"}) {
    for (const double width : {0.0, 0.5, 1.0}) {
      SimulationConfig config;
      config.robot.dead_zone_kind = kind;
      config.robot.dead_zone = {0.004 * width, 0.004 * width, 0.004 * width, 0.0004 * width};
      const SimulationSummary summary = run(ControllerSetup(), config, 60.0);
      EXPECT_LT(summary.moving_share, 0.1) << kind << ' ' << width;
      config.corner_noise = 0.0;
      EXPECT_EQ(run(ControllerSetup(), config, 60.0).moving_share, 0.0) << kind << ' ' << width;
    }
  }
}

TEST(ServoSimulation, ConvergesWithDepthAndDistanceWrongByTwo) {
  for (const double distance : {0.04, 0.08, 0.16}) {
    for (const double factor : {0.5, 1.0, 2.0}) {
      SimulationConfig config;
      config.tissue_distance = distance;
      config.believed_depth_factor = factor;
      config.start = {0.05, 0.05, 0.1, 0.005};
      ControllerSetup controller;
      // A wrong lever moves the free scope of this simulation sideways; a trocar would hold it.
      controller.control.safety.max_lateral_offset = 0.1;
      const SimulationSummary summary = run(controller, config, 60.0);
      EXPECT_GT(summary.settling_time, 0.0) << distance << ' ' << factor;
    }
  }
}

TEST(ServoSimulation, SlantedTissueConverges) {
  SimulationConfig config;
  config.tissue_slant_x = 0.3;
  config.tissue_slant_y = -0.2;
  config.start = {0.08, -0.05, 0.2, -0.01};
  EXPECT_GT(run(ControllerSetup(), config, 60.0).settling_time, 0.0);
}

TEST(ServoSimulation, IsDeterministic) {
  std::ostringstream first;
  std::ostringstream second;
  std::ostringstream other;
  writeCsv(simulate(ControllerSetup(), SimulationConfig(), 3, 5.0), first);
  writeCsv(simulate(ControllerSetup(), SimulationConfig(), 3, 5.0), second);
  writeCsv(simulate(ControllerSetup(), SimulationConfig(), 4, 5.0), other);
  EXPECT_EQ(first.str(), second.str());
  EXPECT_NE(first.str(), other.str());
}

TEST(ServoSimulation, StandsAtADepthOutOfRange) {
  SimulationConfig config = ideal();
  ControllerSetup controller;
  controller.control.safety.max_depth = 0.11;  // the start is deeper than that
  for (const SimulationSample& sample : simulate(controller, config, 1, 2.0)) {
    EXPECT_EQ(sample.state, servo::ControllerState::kIdle);
    EXPECT_EQ(sample.command.vector(), Eigen::Vector4d::Zero());
  }
}

TEST(ServoSimulation, RefusesAStartThatDoesNotSeeTheTissue) {
  SimulationConfig config;
  config.start.pan = 0.8;
  EXPECT_THROW(simulate(ControllerSetup(), config, 1, 1.0), std::invalid_argument);
}

TEST(ServoSimulation, SamplesDescribeTheStart) {
  SimulationConfig config = ideal();
  config.start = {0.0, 0.0, 0.1, 0.02};
  const SimulationSample start = simulate(ControllerSetup(), config, 1, 0.1).front();
  EXPECT_EQ(start.t, 0.0);
  EXPECT_NEAR(start.d2, 0.12, 1e-12);
  EXPECT_NEAR(start.d1 + start.d2, config.scope_length, 1e-12);
  EXPECT_NEAR(start.log_depth, std::log(0.06 / 0.08), 1e-12);
  EXPECT_NEAR(start.alpha, -0.1, 1e-12);
  EXPECT_NEAR(start.u, 319.5, 1e-9);
  EXPECT_NEAR(start.v, 239.5, 1e-9);
}

TEST(Summary, SettlesOnlyWhenItStays) {
  const SimulationConfig config;
  std::vector<SimulationSample> samples(5);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    samples[k].t = static_cast<double>(k);
    samples[k].u = config.roi.centre().x() + (k == 0 || k == 2 ? 3.0 : 1.0);
    samples[k].v = config.roi.centre().y();
  }
  EXPECT_EQ(summarise(samples, config).settling_time, 3.0);
  samples.back().log_depth = 0.03;
  EXPECT_EQ(summarise(samples, config).settling_time, -1.0);
  samples.back().log_depth = std::nan("");
  EXPECT_EQ(summarise(samples, config).settling_time, -1.0);
  EXPECT_EQ(summarise({}, config).settling_time, -1.0);
}

TEST(Csv, HasTheColumnsOfTheInterface) {
  std::ostringstream stream;
  writeCsv(std::vector<SimulationSample>(2), stream);
  std::istringstream lines(stream.str());
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line,
            "t,pan,tilt,spin,insertion,u,v,log_depth,alpha,d1,d2,lateral_speed_at_insertion_point,"
            "lateral_offset_at_insertion_point,state");
  std::getline(lines, line);
  EXPECT_EQ(std::count(line.begin(), line.end(), ','), 13);
}

}  // namespace
}  // namespace laparoscope_servo::closed_loop
