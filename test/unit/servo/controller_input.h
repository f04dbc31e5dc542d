// What the controller is told, good and bad, for its tests.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "laparoscope_servo/servo/controller.h"

namespace laparoscope_servo::servo::test {

inline const double kNan = std::numeric_limits<double>::quiet_NaN();
inline const double kInfinity = std::numeric_limits<double>::infinity();

// Everything that motion relies on is there, and the target is off.
inline ControllerInput good(double time) {
  ControllerInput input;
  input.time = time;
  input.robot = {"", true, 0.1};
  input.task_error.problem.clear();
  input.task_error.valid = true;
  input.task_error.error.e_v = {0.2, -0.1, 0.1};
  input.task_error.error.e_w = {0.0, 0.0, -0.1};
  input.task_error.error.x = 0.2 / 1.1;
  input.task_error.error.y = -0.1 / 1.1;
  input.task_error.error.log_depth = std::log(1.1);
  input.task_error.error.alpha = -0.05;
  input.task_error.age = 0.02;
  input.task_error.image_age = 0.05;
  input.task_error.visible_fraction = 1.0;
  input.task_error.corner_error = 0.1;
  input.depth.problem.clear();
  input.depth.d2 = 0.1;
  input.depth.lateral_offset = 0.001;
  input.depth.age = 0.02;
  return input;
}

// Here the error stays whatever the scope does, as no picture would.
inline ControllerConfig blind(ControllerConfig config = ControllerConfig()) {
  config.effect.enabled = false;
  return config;
}

// The law that sees e_v and e_w alone, as they are.
inline ControllerConfig paper() {
  ControllerConfig config = blind();
  config.law = LawKind::kPaper;
  config.predictor.enabled = false;
  return config;
}

inline bool isZero(const ControllerOutput& output) {
  return output.command.vector() == Eigen::Vector4d::Zero();
}

// A controller that has moved since time 0; the last step was at `time()`.
class Running {
 public:
  explicit Running(const ControllerConfig& config = ControllerConfig()) : controller(blind(config)) {
    EXPECT_EQ(controller.engage(good(0.0)), "");
    for (int k = 0; k <= 50; ++k) last = controller.update(good(time_ = 0.02 * k));
    EXPECT_EQ(last.state, ControllerState::kServo);
    EXPECT_FALSE(isZero(last));
  }

  double time() const { return time_; }
  // A step after the last one.
  ControllerOutput step(ControllerInput input) {
    time_ += 0.02;
    input.time = time_;
    return last = controller.update(input);
  }

  Controller controller;
  ControllerOutput last;

 private:
  double time_ = 0.0;
};

struct Failure {
  std::string name;
  std::function<void(ControllerInput&)> apply;
};

inline std::vector<Failure> failures() {
  std::vector<Failure> all{
      {"no task error", [](ControllerInput& i) { i.task_error = TaskErrorInput(); }},
      {"tracker lost", [](ControllerInput& i) { i.task_error.valid = false; }},
      {"task error stale", [](ControllerInput& i) { i.task_error.age = 0.26; }},
      {"image stale", [](ControllerInput& i) { i.task_error.image_age = 0.26; }},
      {"occluded", [](ControllerInput& i) { i.task_error.visible_fraction = 0.1; }},
      {"task error's age NaN", [](ControllerInput& i) { i.task_error.age = kNan; }},
      {"task error's age negative", [](ControllerInput& i) { i.task_error.age = -0.1; }},
      {"task error's problem", [](ControllerInput& i) { i.task_error.problem = "anything"; }},
      {"no depth", [](ControllerInput& i) { i.depth = DepthInput(); }},
      {"depth's problem", [](ControllerInput& i) { i.depth.problem = "tf is silent"; }},
      {"depth stale", [](ControllerInput& i) { i.depth.age = 0.26; }},
      {"picture beside any camera", [](ControllerInput& i) { i.task_error.error.x = 100.0; }},
      {"robot paused", [](ControllerInput& i) { i.robot.enabled = false, i.robot.paused = true; }},
      {"depth's age NaN", [](ControllerInput& i) { i.depth.age = kNan; }},
  };
  for (const double d2 : {0.0, -0.1, 0.019, 0.251, 1e300, kNan, kInfinity, -kInfinity}) {
    all.push_back({"d2 = " + std::to_string(d2), [d2](ControllerInput& i) { i.depth.d2 = d2; }});
  }
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (int k = 0; k < 3; ++k) {
      const std::string suffix = "[" + std::to_string(k) + "] = " + std::to_string(bad);
      all.push_back({"e_v" + suffix, [=](ControllerInput& i) { i.task_error.error.e_v[k] = bad; }});
      all.push_back({"e_w" + suffix, [=](ControllerInput& i) { i.task_error.error.e_w[k] = bad; }});
      all.push_back({"m_star" + suffix, [=](ControllerInput& i) { i.task_error.error.m_star[k] = bad; }});
    }
    double TaskError::*const scalars[] = {
        &TaskError::x,         &TaskError::y,         &TaskError::log_depth,         &TaskError::alpha,
        &TaskError::desired_x, &TaskError::desired_y, &TaskError::desired_log_depth, &TaskError::desired_alpha};
    for (double TaskError::*const scalar : scalars) {
      all.push_back(
          {"feature = " + std::to_string(bad), [=](ControllerInput& i) { i.task_error.error.*scalar = bad; }});
    }
  }
  return all;
}

inline std::vector<Failure> faults() {
  return {
      {"shaft beside the insertion point", [](ControllerInput& i) { i.depth.lateral_offset = 0.02; }},
      {"lateral offset NaN", [](ControllerInput& i) { i.depth.lateral_offset = kNan; }},
      {"clock jump", [](ControllerInput& i) { i.clock_jump = "ROS time jumped back"; }},
  };
}

}  // namespace laparoscope_servo::servo::test
