// Gains and thresholds that change while the scope moves.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "controller_input.h"
#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::servo {
namespace {

using namespace test;

constexpr double kPeriod = 0.02;  // s, of Running

// A target a little off, within reach of the law without its limits.
ControllerInput little(double x) {
  ControllerInput input = good(0.0);
  input.task_error.error = TaskError();
  input.task_error.error.e_v = {x, 0.0, 0.0};
  input.task_error.error.x = x;
  return input;
}

TEST(ControllerRetune, AGainCountsFromTheNextStepsOn) {
  ControllerConfig config = paper();
  config.rest.enabled = false;
  config.dead_zone.inverse = false;
  Running running(config);
  for (int k = 0; k < 100; ++k) running.step(little(0.02));
  const double before = running.last.command.vector().norm();
  ASSERT_GT(before, 0.0);
  config.gains.pan = 2.0 * config.gains.pan;
  config.gains.tilt = 2.0 * config.gains.tilt;
  running.controller.retune(config);
  for (int k = 0; k < 100; ++k) running.step(little(0.02));
  EXPECT_NEAR(running.last.command.vector().norm(), 2.0 * before, 1e-9);
  EXPECT_EQ(running.last.state, ControllerState::kServo);
}

TEST(ControllerRetune, BandsOfRestCountFromTheNextStepOn) {
  ControllerConfig config = paper();
  Running running(config);
  for (int k = 0; k < 100; ++k) running.step(little(0.02));
  ASSERT_FALSE(isZero(running.last));
  config.rest.centre_stop = config.rest.centre_start = 0.1;
  running.controller.retune(config);
  for (int k = 0; k < 20; ++k) running.step(little(0.02));
  EXPECT_TRUE(isZero(running.last));
  EXPECT_EQ(running.last.state, ControllerState::kServo);
}

TEST(ControllerRetune, TheCommandDoesNotJump) {
  for (const LawKind law : {LawKind::kFeatures, LawKind::kPaper}) {
    ControllerConfig config;
    config.law = law;
    config.dead_zone.inverse = false;  // its step is on top
    Running running(config);
    const Eigen::Vector4d most = kPeriod * config.limits.acceleration.vector();
    Eigen::Vector4d last = running.last.command.vector();
    bool changed = false;
    for (int k = 0; k < 300; ++k) {
      if (k % 7 == 0) {
        const bool high = k % 14 == 0;
        config.gains = high ? PaperGains{5.0, 5.0, 5.0, 0.5} : PaperGains{0.0, 0.0, 0.0, 0.0};
        config.features.centre = config.features.depth = config.features.orientation = high ? 20.0 : 0.0;
        running.controller.retune(config);
      }
      const Eigen::Vector4d now = running.step(good(0.0)).command.vector();
      ASSERT_TRUE(((now - last).cwiseAbs().array() <= most.array() + 1e-9).all()) << "step " << k;
      changed = changed || (now - last).norm() > 0.5 * most.minCoeff();
      last = now;
    }
    EXPECT_TRUE(changed) << "gains have to show";
    EXPECT_EQ(running.last.state, ControllerState::kServo);
  }
}

TEST(ControllerRetune, LimitsAndSafetyStay) {
  ControllerConfig config = paper();
  config.dead_zone.inverse = false;
  Running running(config);
  ControllerConfig other = config;
  other.limits.velocity = {1.0, 1.0, 1.0, 0.1};
  other.limits.acceleration = {100.0, 100.0, 100.0, 10.0};
  other.safety.max_task_error_age = 1.0;
  other.rest.enabled = false;
  running.controller.retune(other);
  ControllerInput far = good(0.0);
  far.task_error.error.e_v = {5.0, -5.0, -0.9};
  const Eigen::Vector4d most = kPeriod * config.limits.acceleration.vector();
  for (int k = 0; k < 100; ++k) {
    const Eigen::Vector4d last = running.last.command.vector();
    const Eigen::Vector4d now = running.step(far).command.vector();
    ASSERT_TRUE((now.cwiseAbs().array() <= config.limits.velocity.vector().array() + 1e-9).all());
    ASSERT_TRUE(((now - last).cwiseAbs().array() <= most.array() + 1e-9).all());
  }
  ControllerInput stale = good(0.0);
  stale.task_error.age = 0.3;
  EXPECT_EQ(running.step(stale).state, ControllerState::kHold);
  EXPECT_TRUE(isZero(running.last));
}

using Commands = std::vector<Eigen::Vector4d>;

// Commands for errors that swing through the bands of rest, with an amplitude that grows. Once the scope moves, the
// parameter `name` is set to `factor` times its value; empty: none. Empty if that value is refused.
Commands commands(LawKind law, const std::string& name, double factor) {
  ControllerConfig config = blind();
  config.law = law;
  Running running(config);
  parameters::Table table;
  describe(table, config);
  if (!name.empty()) {
    const parameters::Row* row = table.find(name);
    if (!row->take(factor * *parameters::numberOf(row->get())).empty() || !validate(config).empty()) return {};
  }
  running.controller.retune(config);
  Commands result;
  for (int k = 0; k < 600; ++k) {
    const double swing = k / 600.0 * std::sin(2.0 * M_PI * 0.02 * k / 1.4);
    ControllerInput input = good(0.0);
    TaskError& error = input.task_error.error;
    error.x = error.y = 0.005 * swing;
    error.log_depth = 0.015 * swing;
    error.alpha = 0.015 * swing;
    error.e_v = {error.x, error.y, error.log_depth};
    error.e_w = {0.0, 0.0, 2.0 * error.alpha};
    result.push_back(running.step(input).command.vector());
  }
  return result;
}

// A value that is accepted and logged, but not passed on to the part that uses it, would have no effect.
TEST(ControllerRetune, EveryParameterThatMayChangeHasAnEffect) {
  ControllerConfig config;
  parameters::Table table;
  describe(table, config);
  const LawKind laws[] = {LawKind::kFeatures, LawKind::kPaper};
  const Commands as_before[] = {commands(laws[0], "", 1.0), commands(laws[1], "", 1.0)};
  int changeable = 0;
  for (const parameters::Row& row : table.rows()) {
    if (!row.while_running) continue;
    ++changeable;
    bool has_effect = false;
    for (const double factor : {1.3, 0.7}) {
      for (const int k : {0, 1}) {
        if (has_effect) continue;
        const Commands changed = commands(laws[k], row.name, factor);
        has_effect = !changed.empty() && changed != as_before[k];
      }
    }
    EXPECT_TRUE(has_effect) << row.name;
  }
  EXPECT_GT(changeable, 0);
}

TEST(ControllerRetune, NothingMovesWhileItStands) {
  Controller controller(paper());
  ControllerConfig config = paper();
  config.gains.pan = 5.0;
  controller.retune(config);
  EXPECT_TRUE(isZero(controller.update(good(0.0))));
  EXPECT_FALSE(controller.engaged());
}

}  // namespace
}  // namespace laparoscope_servo::servo
