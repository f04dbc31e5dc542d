// ScopeServo in a loop with an ideal robot, for its tests.
#pragma once

#include <cmath>

#include "plane_loop.h"
#include "servo/scope_servo.h"

namespace laparoscope_servo::servo::test {

constexpr double kPeriod = 0.02;  // s

// The loop with an ideal robot that executes after a delay, images every other step.
class Loop {
 public:
  Loop(const ControllerConfig& config, double delay) : servo(config), robot_(10.0, 0.2), delay_(delay) {
    robot_.add(-1.0, scope::Velocity());
  }

  scope::Velocity step(bool report = false) {
    if (count_ % 2 == 0) {
      image_ = loop.error();
      image_time_ = time_;
    }
    if (report) servo.report(time_, scope::Velocity::fromVector(robot_.velocity(time_, delay_)));
    const scope::Velocity command = servo.command(input(), limits);
    execute(command);
    return command;
  }

  void drive(const scope::Velocity& wanted) { execute(servo.drive(input(), wanted)); }
  void restart() { servo.restart(time_); }

  ScopeServo servo;
  PlaneLoop loop{Eigen::Vector3d::UnitZ(), kZ, straight()};
  ServoLimits limits;

 private:
  ServoInput input() const {
    ServoInput input;
    input.time = time_;
    input.image_time = image_time_;
    input.error = image_;
    input.scope = loop.scope();
    input.period = count_ == 0 ? 0.0 : kPeriod;
    return input;
  }

  void execute(const scope::Velocity& command) {
    robot_.add(time_, command);
    for (int k = 0; k < 20; ++k) {
      const double t = time_ + (k + 0.5) * kPeriod / 20.0;
      loop.move(scope::Velocity::fromVector(robot_.velocity(t, delay_)), kPeriod / 20.0);
    }
    time_ += kPeriod;
    ++count_;
  }

  CommandHistory robot_;
  double delay_;
  TaskError image_;
  double time_ = 0.0, image_time_ = 0.0;
  int count_ = 0;
};

inline ControllerConfig withoutDeadZone() {
  ControllerConfig config;
  config.dead_zone.inverse = false;
  config.dead_zone.width = scope::Velocity();
  return config;
}

inline double centre(const PlaneLoop& loop) {
  const TaskError error = loop.error();
  return std::hypot(error.x - error.desired_x, error.y - error.desired_y);
}

}  // namespace laparoscope_servo::servo::test
