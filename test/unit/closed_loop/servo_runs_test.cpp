// Starts drawn at random, and what a run comes to.
#include "laparoscope_servo/closed_loop/servo_runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <sstream>
#include <stdexcept>

namespace laparoscope_servo::closed_loop {
namespace {

SimulationConfig spread() {
  SimulationConfig config;
  config.start = {0.01, -0.02, 0.1, 0.005};
  config.start_spread = {0.05, 0.04, 0.3, 0.01};
  return config;
}

TEST(DrawStart, WithoutASpreadIsTheStart) {
  SimulationConfig config;
  config.start.pan = 0.8;  // sees nothing: for simulate() to refuse
  const DrawnStart drawn = drawStart(config, 3);
  EXPECT_EQ(drawn.start.vector(), config.start.vector());
  EXPECT_EQ(drawn.refused, 0);
}

TEST(DrawStart, FillsTheSpreadAndStaysWithinIt) {
  const SimulationConfig config = spread();
  constexpr int kDraws = 500;
  Eigen::Vector4d sum = Eigen::Vector4d::Zero(), furthest = Eigen::Vector4d::Zero();
  for (unsigned seed = 1; seed <= kDraws; ++seed) {
    const Eigen::Vector4d share =
        (drawStart(config, seed).start.vector() - config.start.vector()).cwiseQuotient(config.start_spread.vector());
    ASSERT_LE(share.cwiseAbs().maxCoeff(), 1.0) << seed;
    sum += share;
    furthest = furthest.cwiseMax(share.cwiseAbs());
  }
  EXPECT_GT(furthest.minCoeff(), 0.98);
  EXPECT_LT((sum / kDraws).cwiseAbs().maxCoeff(), 4.0 / std::sqrt(3.0 * kDraws));  // four standard deviations of a mean
}

TEST(DrawStart, OfZeroSpreadInOneComponentMovesTheOthersOnly) {
  SimulationConfig config = spread();
  config.start_spread.spin = 0.0;
  const scope::Velocity start = drawStart(config, 1).start;
  EXPECT_EQ(start.spin, config.start.spin);
  EXPECT_NE(start.pan, config.start.pan);
}

TEST(DrawStart, SameSeedSameStart) {
  EXPECT_EQ(drawStart(spread(), 7).start.vector(), drawStart(spread(), 7).start.vector());
  EXPECT_NE(drawStart(spread(), 7).start.vector(), drawStart(spread(), 8).start.vector());
}

// The same numbers on every machine; these are std::seed_seq's and std::mt19937's, which the standard lays down.
TEST(DrawStart, TheFirstSeedGivesTheseNumbers) {
  SimulationConfig config;
  config.start = {0.0, 0.0, 0.0, 0.0};
  config.start_spread = {0.01, 0.01, 0.01, 0.01};
  std::seed_seq sequence{1u, 1u};
  std::mt19937 random(sequence);
  const Eigen::Vector4d start = drawStart(config, 1).start.vector();
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(start[k], 0.01 * (2.0 * (random() + 0.5) / 4294967296.0 - 1.0), 1e-15);
  }
}

TEST(DrawStart, EachSeesTheRegion) {
  SimulationConfig config;
  config.start_spread = {0.4, 0.4, 0.7, 0.02};
  int refused = 0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const DrawnStart drawn = drawStart(config, seed);
    SimulationConfig started = config;
    started.start = drawn.start;
    EXPECT_TRUE(startSeesRoi(started)) << seed;
    refused += drawn.refused;
  }
  EXPECT_GT(refused, 10);
}

TEST(DrawStart, GivesUpWhenNothingIsToBeSeen) {
  SimulationConfig config;
  config.start = {1.1, 0.0, 0.0, 0.0};
  config.start_spread.pan = 0.1;
  EXPECT_THROW(drawStart(config, 1), std::invalid_argument);
}

// 10 Hz, all at the target and standing.
std::vector<SimulationSample> still(std::size_t count) {
  std::vector<SimulationSample> samples(count);
  const Eigen::Vector2d target = SimulationConfig().roi.centre();
  for (std::size_t k = 0; k < count; ++k) {
    samples[k].t = 0.1 * static_cast<double>(k);
    samples[k].u = target.x();
    samples[k].v = target.y();
    samples[k].worst_corner = 100.0;
    samples[k].state = servo::ControllerState::kServo;
  }
  return samples;
}

RunSummary summarised(const std::vector<SimulationSample>& samples, double rest_after = 0.0) {
  RunBounds bounds;
  bounds.rest_after = rest_after;
  return summariseRun(samples, SimulationConfig(), bounds);
}

TEST(SummariseRun, AtTheTargetAllIsZero) {
  const RunSummary run = summarised(still(10));
  EXPECT_EQ(run.settled, 0.0);
  EXPECT_EQ(run.centre_rms, 0.0);
  EXPECT_EQ(run.scale_rms, 0.0);
  EXPECT_EQ(run.orientation_rms, 0.0);
  EXPECT_EQ(run.moving_share, 0.0);
  EXPECT_EQ(run.reversals, 0);
  EXPECT_FALSE(run.left_image);
  EXPECT_EQ(run.final_state, servo::ControllerState::kServo);
}

// Each bound is left for the last time at another moment; all three are kept from the last of these on.
TEST(SummariseRun, SettlesWhenItStaysWithinEachBound) {
  std::vector<SimulationSample> samples = still(10);
  samples[0].u += 1.1;
  samples[2].v -= 1.1;
  samples[3].u += 0.9;
  samples[4].log_depth = -0.011;
  samples[6].alpha = -0.009;
  const RunSummary run = summarised(samples);
  EXPECT_DOUBLE_EQ(run.settled_centre, 0.3);
  EXPECT_DOUBLE_EQ(run.settled_scale, 0.5);
  EXPECT_DOUBLE_EQ(run.settled_orientation, 0.7);
  EXPECT_DOUBLE_EQ(run.settled, 0.7);
  samples.back().u += 2.0;
  EXPECT_EQ(summarised(samples).settled_centre, -1.0);
  EXPECT_EQ(summarised(samples).settled, -1.0);
  EXPECT_DOUBLE_EQ(summarised(samples).settled_scale, 0.5);
}

TEST(SummariseRun, WhatIsNoNumberIsNotSettled) {
  for (double SimulationSample::*field :
       {&SimulationSample::u, &SimulationSample::log_depth, &SimulationSample::alpha}) {
    std::vector<SimulationSample> samples = still(10);
    samples.back().*field = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(summarised(samples).settled, -1.0);
  }
}

TEST(SummariseRun, TakesFiguresOfRestFromThenOn) {
  std::vector<SimulationSample> samples = still(10);
  samples[0].u += 1000.0;
  samples[0].log_depth = samples[0].alpha = 1.0;
  samples[0].command.pan = 0.1;
  samples[6].u += 3.0;
  samples[6].v += 4.0;
  samples[7].log_depth = -std::log(1.02);
  samples[8].alpha = 0.04;
  samples[9].command.insertion = -1e-6;
  const RunSummary run = summarised(samples, 0.6 - 1e-9);
  EXPECT_NEAR(run.centre_rms, 2.5, 1e-12);
  EXPECT_NEAR(run.scale_rms, 0.01, 1e-12);
  EXPECT_NEAR(run.orientation_rms, 0.02, 1e-12);
  EXPECT_DOUBLE_EQ(run.moving_share, 0.25);
}

TEST(SummariseRun, CountsReversalsOfEachComponentAcrossPauses) {
  std::vector<SimulationSample> samples = still(10);
  for (const std::size_t k : {1u, 2u, 6u}) samples[k].command.tilt = 0.01;
  for (const std::size_t k : {4u, 8u}) samples[k].command.tilt = -0.01;
  samples[2].command.spin = -0.02;
  samples[3].command.spin = 0.02;
  EXPECT_EQ(summarised(samples).reversals, 4);
  EXPECT_EQ(summarised(samples, 0.35).reversals, 2);  // what was before is not looked at
}

TEST(SummariseRun, KeepsTheWorst) {
  std::vector<SimulationSample> samples = still(10);
  samples[1].worst_corner = -0.1;
  samples[2].commanded_lateral_speed = 0.001;
  samples[3].lateral_speed = 0.002;
  samples[4].lateral_offset = 0.003;
  samples[9].state = servo::ControllerState::kLost;
  const RunSummary run = summarised(samples, 0.8);
  EXPECT_TRUE(run.left_image);
  EXPECT_EQ(run.max_commanded_lateral_speed, 0.001);
  EXPECT_EQ(run.max_lateral_speed, 0.002);
  EXPECT_EQ(run.max_lateral_offset, 0.003);
  EXPECT_EQ(run.final_state, servo::ControllerState::kLost);
}

// What was no number once is none of the worst: a small one would say that nothing went wrong.
TEST(SummariseRun, WhatIsNoNumberIsNotSmall) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<SimulationSample> samples = still(10);
  samples[3].lateral_speed = samples[3].lateral_offset = samples[3].commanded_lateral_speed = nan;
  samples[3].evidence = samples[3].unconfirmed = samples[3].leash = nan;
  samples[3].moved.setConstant(nan);
  const RunSummary run = summarised(samples);
  for (const double figure : {run.max_lateral_speed, run.max_lateral_offset, run.max_commanded_lateral_speed,
                              run.evidence, run.unconfirmed, run.leash, run.turned, run.inserted})
    EXPECT_TRUE(std::isnan(figure)) << figure;
  const SimulationSummary summary = summarise(samples, SimulationConfig());
  EXPECT_TRUE(std::isnan(summary.max_lateral_speed));
  EXPECT_TRUE(std::isnan(summary.max_lateral_offset));
}

TEST(SummariseRun, TellsWhereTheScopeWentAndWhatStoppedIt) {
  std::vector<SimulationSample> samples = still(10);
  samples[1].moved << 0.03, -0.04, 0.01, 0.001;
  samples[1].evidence = 2.0;
  samples[2].moved << 0.0, 0.0, -0.02, -0.004;
  for (const std::size_t k : {3u, 5u, 6u}) samples[k].state = servo::ControllerState::kHold;
  samples[5].evidence = 7.0;
  samples[5].unconfirmed = 0.6;
  samples[5].leash = 0.7;
  for (const std::size_t k : {7u, 8u, 9u}) samples[k].state = servo::ControllerState::kFault;
  samples[8].evidence = 50.0;  // nobody is engaged any more
  const RunSummary run = summarised(samples);
  EXPECT_DOUBLE_EQ(run.turned, 0.05);
  EXPECT_DOUBLE_EQ(run.inserted, 0.004);
  EXPECT_EQ(run.holds, 2);
  EXPECT_EQ(run.stopped, samples[7].t);
  EXPECT_EQ(run.evidence, 7.0);
  EXPECT_EQ(run.unconfirmed, 0.6);
  EXPECT_EQ(run.leash, 0.7);
}

TEST(SummariseRun, CountsTheWayFromWhenThePictureFroze) {
  std::vector<SimulationSample> samples = still(10);
  for (std::size_t k = 0; k < 10; ++k) samples[k].moved << 0.01 * static_cast<double>(k), 0.0, 0.0, 0.0;
  SimulationConfig config;
  config.picture.frozen_from = samples[4].t;
  EXPECT_NEAR(summariseRun(samples, config, RunBounds()).turned, 0.05, 1e-12);
}

// Towards the place and beyond it is no way away before it is as far on the other side.
TEST(SummariseRun, TellsHowFarTheScopeWentAwayFromItsPlace) {
  std::vector<SimulationSample> samples = still(10);
  SimulationConfig config;
  config.start = {0.03, 0.04, 0.01, -0.002};
  samples[1].moved << -0.06, -0.08, 0.0, 0.004;
  EXPECT_NEAR(summariseRun(samples, config, RunBounds()).turned_away, 0.0, 1e-12);
  EXPECT_NEAR(summariseRun(samples, config, RunBounds()).inserted_away, 0.0, 1e-12);
  samples[2].moved << -0.09, -0.12, 0.0, 0.005;
  EXPECT_NEAR(summariseRun(samples, config, RunBounds()).turned_away, 0.05, 1e-12);
  EXPECT_NEAR(summariseRun(samples, config, RunBounds()).inserted_away, 0.001, 1e-12);
  samples[3].moved << 0.0, 0.0, 0.07, 0.0;
  EXPECT_NEAR(summariseRun(samples, config, RunBounds()).turned_away, 0.07, 1e-12);
  config.picture.frozen_from = samples[2].t;
  EXPECT_NEAR(summariseRun(samples, config, RunBounds()).inserted_away, 0.0, 1e-12) << "from there, it came nearer";
}

TEST(WriteRuns, AColumnForEachFigure) {
  RunSummary run;
  run.seed = 2;
  run.drawn = {{3.0, 4.0, 5.0, 6.0}, 7};
  run.settled = 8.0;
  run.settled_centre = 9.0;
  run.settled_scale = 10.0;
  run.settled_orientation = 11.0;
  run.left_image = true;
  run.centre_rms = 12.0;
  run.scale_rms = 13.0;
  run.orientation_rms = 14.0;
  run.moving_share = 15.0;
  run.reversals = 16;
  run.max_commanded_lateral_speed = 17.0;
  run.max_lateral_speed = 18.0;
  run.max_lateral_offset = 19.0;
  run.final_state = servo::ControllerState::kHold;
  run.stopped = 20.0;
  run.holds = 21;
  run.turned = 22.0;
  run.inserted = 23.0;
  run.turned_away = 24.0;
  run.inserted_away = 25.0;
  run.evidence = 26.0;
  run.unconfirmed = 27.0;
  run.leash = 28.0;
  run.faced = 29.0;
  run.slant = 30.0;
  run.normal_error = 31.0;
  std::ostringstream stream;
  writeRuns({run}, stream);
  EXPECT_EQ(stream.str(),
            "seed,start_pan,start_tilt,start_spin,start_insertion,refused_starts,settled,settled_centre,settled_scale,"
            "settled_orientation,left_image,centre_rms,scale_rms,orientation_rms,moving_share,reversals,"
            "max_commanded_lateral_speed,max_lateral_speed,max_lateral_offset,final_state,stopped,holds,"
            "turned,inserted,turned_away,inserted_away,evidence,unconfirmed,leash,faced,slant,normal_error\n"
            "2,3,4,5,6,7,8,9,10,11,1,12,13,14,15,16,17,18,19,HOLD,20,21,22,23,24,25,26,27,28,29,30,31\n");
}

TEST(PrintRuns, NamesTheSeedsThatDidNotSettle) {
  std::vector<RunSummary> runs(3);
  runs[0].seed = 11;
  runs[0].settled = 2.0;
  runs[1].seed = 12;
  runs[1].drawn.refused = 4;
  runs[1].centre_rms = std::numeric_limits<double>::quiet_NaN();
  runs[2].seed = 13;
  runs[2].settled = 1.0;
  runs[2].left_image = true;
  std::ostringstream stream;
  printRuns(runs, RunBounds(), stream);
  for (const char* part : {"3 runs, 4 starts", "1 runs left the image", "0.5 deg: 2\n", "not settled, seeds: 12\n",
                           "after: median 2 s, 95 % -, worst -\n", "centre rms: median 0 px, 95 % -, worst -\n"}) {
    EXPECT_NE(stream.str().find(part), std::string::npos) << part << " is not in\n" << stream.str();
  }
}

}  // namespace
}  // namespace laparoscope_servo::closed_loop
