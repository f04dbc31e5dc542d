// The controller, an ideal scope under an insertion point and a plane of tissue, in simulated time, without images and
// without ROS: what the controller is told may be changed on its way.
//
// World frame: the camera's at the reference pose. The robot executes after a delay, through a dead zone, and only
// while it is ENABLED.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <random>
#include <string>

#include "laparoscope_servo/aesop/command_guard.h"
#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/scope/insertion_point.h"
#include "laparoscope_servo/servo/controller.h"
#include "laparoscope_servo/servo/view_region.h"
#include "laparoscope_servo/sim/scope_actuator.h"
#include "laparoscope_servo/sim/scope_body.h"

namespace laparoscope_servo::test {

// How far the scope has moved, by its degrees of freedom: the most of pan, tilt and spin, and the insertion.
struct ScopeTravel {
  double angle = 0.0;     // rad
  double distance = 0.0;  // m
};

// What lies between the truth and the controller. As constructed, nothing does.
struct Interference {
  std::function<void(Eigen::Matrix3d& h)> picture;             // of what the camera shows, normalised
  std::function<void(servo::TaskErrorInput&)> tracker;         // once for each image
  std::function<void(servo::ControllerInput&, double)> input;  // in each step; the time [s]
};

class SimulatedCart {
 public:
  static constexpr double kTick = 0.005;      // s, of the integration
  static constexpr double kFirstStamp = 1.0;  // s: a stamp of zero would be none
  static constexpr int kControlTicks = 4;     // 50 Hz
  static constexpr int kImageTicks = 8;       // 25 Hz
  static constexpr double kDepth = 0.1;       // m, d2 at the reference
  static constexpr double kLength = 0.35;     // m, of the scope
  static constexpr double kDistance = 0.08;   // m, from the reference camera to the tissue

  // `start`: from the reference pose, rad and m.
  SimulatedCart(const servo::ControllerConfig& config, const scope::Velocity& start, unsigned seed)
      : controller(config), random_(seed), body_(startPose(start), {0.0, 0.0, -kDepth}, kLength) {}

  // One tick; after it `output` is of the controller's last step.
  void step() {
    if (ticks_ % kImageTicks == 0) expose();
    if (ticks_ % kControlTicks == 0) control();
    execute();
    ++ticks_;
  }
  template <typename Condition>
  bool until(Condition condition, double seconds) {
    for (const double end = time() + seconds; !condition();) {
      if (time() > end) return false;
      step();
    }
    return true;
  }
  void pass(double seconds) {
    until([] { return false; }, seconds);
  }

  double time() const { return ticks_ * kTick; }
  const Eigen::Isometry3d& pose() const { return body_.pose(); }
  // Since `from`.
  ScopeTravel travel(const Eigen::Isometry3d& from) const {
    return {geometry::so3Log(from.linear().transpose() * pose().linear()).cwiseAbs().maxCoeff(),
            std::abs((insertionPoint().inverse() * pose()).translation().norm() -
                     (insertionPoint().inverse() * from).translation().norm())};
  }
  // What the robot does now, rad/s and m/s.
  const Eigen::Vector4d& velocity() const { return executed_; }
  // px, of the region's centre from where it has to be.
  double offset() const {
    return (geometry::apply(geometry::pixelsFromNormalised(homography(), camera_), roi_.centre()) - roi_.centre())
        .norm();
  }
  // rad, of the shaft from where it has to be: by pan and tilt.
  double aside() const { return std::acos(std::min(1.0, pose().linear()(2, 2))); }
  bool seesRegion() const {
    const auto corners = geometry::apply(geometry::pixelsFromNormalised(homography(), camera_), roi_.corners());
    if (!geometry::isConvex(corners)) return false;
    for (const Eigen::Vector2d& p : corners) {
      if (!(p.x() >= 0.0 && p.y() >= 0.0 && p.x() <= 639.0 && p.y() <= 479.0)) return false;
    }
    return true;
  }
  // What the controller would be told now.
  servo::ControllerInput input() {
    servo::ControllerInput input;
    input.time = time();
    input.robot = {"", disabled == 0, 0.02};
    input.dead_man = {pressed, 0.01};
    input.manual = {manual, 0.01};
    input.task_error = seen_;
    input.task_error.age = input.task_error.image_age = time() - seen_at_;
    input.task_error.image_time = seen_at_;
    input.depth.problem.clear();
    input.depth.d2 = body_.depth();
    input.depth.lateral_offset = body_.lateralOffset();
    input.depth.age = 0.01;
    input.depth.insertion_point_T_tip = insertionPoint().inverse() * body_.pose();
    input.robot_report = {true, 0.0, scope::Velocity::fromVector(says_what_it_is_told > 0 ? told_ : executed_)};
    if (interference.input) interference.input(input, time());
    return input;
  }

  servo::Controller controller;
  servo::ControllerOutput output;
  Interference interference;
  int disabled = 0;           // causes, of the robot
  int controller_stalls = 0;  // causes
  // The robot moves by this factor of what it is told, and so much [s] later than it was.
  Eigen::Vector4d gain = Eigen::Vector4d::Ones();
  double lag = 0.0;
  int says_what_it_is_told = 0;  // causes; otherwise it says what it does
  bool pressed = true;           // the dead-man switch
  scope::Velocity manual;        // what somebody wants in MANUAL

 private:
  static Eigen::Isometry3d startPose(const scope::Velocity& start) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Vector3d(0.0, 0.0, -kDepth);
    pose.linear() = geometry::so3Exp({start.tilt, start.pan, 0.0}) * geometry::so3Exp({0.0, 0.0, start.spin});
    return pose * Eigen::Translation3d(0.0, 0.0, kDepth + start.insertion);
  }

  // World_T_insertion_point, z out of the body.
  static Eigen::Isometry3d insertionPoint() {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Vector3d(0.0, 0.0, -kDepth);
    pose.linear() = geometry::so3Exp({M_PI, 0.0, 0.0});
    return pose;
  }

  Eigen::Matrix3d homography() const {
    return geometry::fromPlane(body_.pose().inverse(), Eigen::Vector3d::UnitZ(), kDistance);
  }

  // Of the whole view, whose larger part has less noise.
  servo::ViewMotion viewMotion(const Eigen::Matrix3d& h, double error) const {
    const geometry::Rectangle view = servo::viewRegion(2.0 * camera_.cx + 1.0, 2.0 * camera_.cy + 1.0);
    return {h, geometry::apply(camera_.inverseMatrix(), view.corners()), error / camera_.fx};
  }

  void expose() {
    servo::TaskErrorInput task;
    task.problem.clear();
    task.region = 1.0;
    task.visible_fraction = 1.0;
    task.corner_error = 0.3;
    Eigen::Matrix3d h = homography();
    task.valid = seesRegion();
    if (task.valid) {
      if (interference.picture) interference.picture(h);
      try {
        auto corners = geometry::apply(geometry::pixelsFromNormalised(h, camera_), roi_.corners());
        std::normal_distribution<double> noise(0.0, 0.3);
        for (Eigen::Vector2d& corner : corners) corner += Eigen::Vector2d(noise(random_), noise(random_));
        task.error = servo::taskError(
            geometry::normalisedFromPixels(geometry::fromCorners(roi_.corners(), corners), camera_), roi_, camera_);
        task.motion = viewMotion(h, task.corner_error);
      } catch (const std::invalid_argument&) {
        task.valid = false;
      }
    }
    if (interference.tracker) interference.tracker(task);
    seen_ = task;
    seen_at_ = time();
  }

  void control() {
    if (controller_stalls == 0) {
      output = controller.update(input());
      guard_.accept(output.command, kFirstStamp + time(), kFirstStamp + time(), time());
    }
    if (disabled != 0) return;
    commanded_for_ = std::max(commanded_for_, time() + lag);
    actuator_.command(commanded_for_, guard_.velocity(time()).vector());
  }

  void execute() {
    if (disabled != 0) actuator_ = sim::ScopeActuator(sim::ScopeActuatorConfig());  // it brakes at once
    told_ = actuator_.velocity(time());
    executed_ = gain.cwiseProduct(told_);
    const auto velocity = scope::Velocity::fromVector(executed_);
    sim::ScopeBody halfway = body_;
    halfway.move(scope::endEffectorTwist(velocity, kLength - body_.depth()), 0.5 * kTick);
    body_.move(scope::endEffectorTwist(velocity, kLength - halfway.depth()), kTick);
  }

  std::mt19937 random_;
  geometry::PinholeCamera camera_{400.0, 400.0, 319.5, 239.5};
  geometry::Rectangle roi_{270.0, 190.0, 100.0, 100.0};
  sim::ScopeBody body_;
  sim::ScopeActuator actuator_{sim::ScopeActuatorConfig()};
  double commanded_for_ = 0.0;                      // s, of the last command, which the actuator delays
  Eigen::Vector4d told_ = Eigen::Vector4d::Zero();  // by the command that is due
  Eigen::Vector4d executed_ = Eigen::Vector4d::Zero();
  servo::TaskErrorInput seen_;
  double seen_at_ = -1.0;
  aesop::CommandGuard guard_{aesop::CommandConfig()};
  long ticks_ = 0;
};

}  // namespace laparoscope_servo::test
