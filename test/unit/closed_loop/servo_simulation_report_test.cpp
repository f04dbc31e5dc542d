#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "laparoscope_servo/closed_loop/servo_simulation.h"

namespace laparoscope_servo::closed_loop {
namespace {

// A sample a second, at the target and at rest.
std::vector<SimulationSample> still(int count) {
  const SimulationConfig config;
  std::vector<SimulationSample> samples(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    samples[static_cast<std::size_t>(k)].t = k;
    samples[static_cast<std::size_t>(k)].u = config.roi.centre().x();
    samples[static_cast<std::size_t>(k)].v = config.roi.centre().y();
  }
  return samples;
}

SimulationSummary summarised(const std::vector<SimulationSample>& samples) {
  return summarise(samples, SimulationConfig(), 2.0, 0.02);
}

TEST(ServoSimulationReport, NothingIsSettledFromItsFirstSampleOn) {
  const SimulationSummary summary = summarised(still(8));
  EXPECT_EQ(summary.settling_time, 0.0);
  EXPECT_EQ(summary.final_offset, 0.0);
  EXPECT_EQ(summary.final_scale_error, 0.0);
  EXPECT_EQ(summary.final_alpha, 0.0);
  EXPECT_EQ(summary.moving_share, 0.0);
  EXPECT_EQ(summarised({}).settling_time, -1.0) << "nothing has settled where nothing was";
  EXPECT_EQ(summarised(still(3)).final_offset, 0.0) << "three have no last quarter";
}

// From where on both stay within their bounds: what leaves once more has not settled yet.
TEST(ServoSimulationReport, SettlesWhereItStaysWithinBothBounds) {
  std::vector<SimulationSample> samples = still(10);
  samples[0].u += 50.0;
  samples[4].v += 2.1;
  EXPECT_EQ(summarised(samples).settling_time, 5.0);
  samples[4].v -= 0.2;
  EXPECT_EQ(summarised(samples).settling_time, 1.0) << "1.9 px are within";
  samples[6].log_depth = std::log(1.03);
  EXPECT_EQ(summarised(samples).settling_time, 7.0) << "3 % smaller";
  samples[9].log_depth = -std::log(1.03);
  EXPECT_EQ(summarised(samples).settling_time, -1.0) << "the last one is larger";
}

TEST(ServoSimulationReport, WhatIsNoNumberHasNotSettled) {
  std::vector<SimulationSample> samples = still(4);
  samples[3].u = std::nan("");
  EXPECT_EQ(summarised(samples).settling_time, -1.0);
  samples = still(4);
  samples[3].log_depth = std::nan("");
  EXPECT_EQ(summarised(samples).settling_time, -1.0);
  EXPECT_TRUE(std::isnan(summarised(samples).final_scale_error)) << "and is not left out of the mean";
}

// Root mean squares over the last quarter alone: here over two samples of eight.
TEST(ServoSimulationReport, FiguresOfRestAreThoseOfTheLastQuarter) {
  std::vector<SimulationSample> samples = still(8);
  for (std::size_t k = 0; k < 6; ++k) {
    samples[k].u += 100.0;
    samples[k].alpha = 1.0;
    samples[k].command.pan = 0.1;
  }
  samples[6].u += 3.0;
  samples[7].v += 4.0;
  samples[7].alpha = -0.2;
  samples[6].log_depth = -std::log(1.1);
  samples[7].command.insertion = 1e-9;
  const SimulationSummary summary = summarised(samples);
  EXPECT_NEAR(summary.final_offset, std::sqrt((9.0 + 16.0) / 2.0), 1e-12);
  EXPECT_NEAR(summary.final_scale_error, 0.1 / std::sqrt(2.0), 1e-12) << "as it is seen: 10 % larger";
  EXPECT_NEAR(summary.final_alpha, 0.2 / std::sqrt(2.0), 1e-12);
  EXPECT_EQ(summary.moving_share, 0.5);
}

TEST(ServoSimulationReport, TheLargestIsThatOfAllAndNoNumberIsNotMissed) {
  std::vector<SimulationSample> samples = still(8);
  samples[1].lateral_speed = 0.02;
  samples[2].lateral_offset = 0.003;
  samples[7].lateral_speed = 0.01;
  EXPECT_EQ(summarised(samples).max_lateral_speed, 0.02);
  EXPECT_EQ(summarised(samples).max_lateral_offset, 0.003);
  samples[3].lateral_offset = std::nan("");
  EXPECT_FALSE(summarised(samples).max_lateral_offset <= 0.003);
}

TEST(ServoSimulationReport, ALineForEachSampleInTheOrderOfTheHead) {
  std::vector<SimulationSample> samples = still(2);
  SimulationSample& s = samples[1];
  s.t = 0.02;
  s.command = {1.0, 2.0, 3.0, 4.0};
  s.u = 5.0;
  s.v = 6.0;
  s.log_depth = 7.0;
  s.alpha = 1.0 / 3.0;
  s.d1 = 9.0;
  s.d2 = 10.0;
  s.lateral_speed = 11.0;
  s.lateral_offset = 12.0;
  s.state = servo::ControllerState::kServo;
  std::ostringstream out;
  writeCsv(samples, out);
  std::istringstream lines(out.str());
  std::string head, first, second, more;
  std::getline(lines, head);
  std::getline(lines, first);
  std::getline(lines, second);
  EXPECT_EQ(head,
            "t,pan,tilt,spin,insertion,u,v,log_depth,alpha,d1,d2,lateral_speed_at_insertion_point,"
            "lateral_offset_at_insertion_point,state");
  EXPECT_EQ(second, "0.02,1,2,3,4,5,6,7,0.333333333333,9,10,11,12,SERVO");
  EXPECT_EQ(std::count(first.begin(), first.end(), ','), std::count(head.begin(), head.end(), ','));
  EXPECT_FALSE(std::getline(lines, more));
}

}  // namespace
}  // namespace laparoscope_servo::closed_loop
