// The whole simulated cart as processes, with a relay between camera and tracker, for tests of what stops it: brought
// to a situation by the steps of the documentation, and measured at the emulator's joints.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera_info_relay.h"
#include "feature_task.h"
#include "image_relay.h"
#include "laparoscope_servo/ControllerState.h"
#include "laparoscope_servo/Homography.h"
#include "operator.h"
#include "scope_travel.h"
#include "stepped_clock.h"
#include "system/aesop/aesop_bench.h"

namespace laparoscope_servo::test {

// SERVO by the region of interest; HOLD; MANUAL; SERVO by an object, by points, by the region's homography, on
// PARALLEL's circle.
enum class Situation : unsigned {
  kServo = 1,
  kHold = 2,
  kManual = 4,
  kFollow = 8,
  kPoints = 16,
  kPosition = 32,
  kParallel = 64
};

constexpr double kStick = 0.08;  // rad/s, of pan, in MANUAL

const char* name(Situation situation);

// What happened after a fault.
struct Reaction {
  Travel travel;
  double nearer = 0.0;  // degrees, to where the region is in its place; negative: further away
  double away = 0.0;    // degrees, by which it was further from there meanwhile, at most
  double swing = 0.0;   // degrees, that a joint goes to and fro in the last 2 s; 0 where it is not watched to the end
  double stood = 0.0;   // s, after the fault; until the end of watching when it did not stand
  double lasted = 0.0;  // s, from the mark until then
  std::string state;    // of the controller, when it stood
  std::string reason;
  std::string robot;  // the same, of the aesop node
};

class FaultCart {
 public:
  FaultCart();

  // Brings the cart to a situation by the documented steps, wherever it is. Says what is in the way, empty: nothing.
  std::string bringTo(Situation situation);

  // From now on, for `seconds`, or for `calm` seconds after the arm has come to rest.
  Reaction watch(double seconds, double calm);
  // The arm's joints at this moment are where watch() counts from.
  void mark();

  // Of services; what they say when they refuse, empty when they do not.
  std::string engage(bool on);
  std::string robot(const std::string& service);

  bool stateIs(const std::string& state) const { return state_ && state_->state == state; }
  const std::string& state() const { return state_ ? state_->state : none_; }
  const std::string& reason() const { return state_ ? state_->reason : none_; }
  // px, of what is tracked from where it has to be; infinite when it is not tracked.
  double offset() const;

  void startCamera();
  void startTracker();  // the one that the situation goes by
  void startController();
  static std::vector<std::string> trackerArguments();
  static std::vector<std::string> controllerArguments();

  SteppedClock clock;  // of all processes that are started after it
  AesopBench bench{false};
  Operator operating;
  std::unique_ptr<ImageRelay> relay;
  std::unique_ptr<CameraInfoRelay> info_relay;
  std::unique_ptr<ChildProcess> camera, tracker, controller;

 private:
  std::string tryToBringTo(Situation situation);
  std::string stand();
  void use(Situation situation);
  std::string see();
  std::string select();
  std::string go(Situation situation);
  void hand(const aesop::JointVector& goal);
  // Why `condition` has not come true; empty when it has.
  std::string waitFor(const char* what, const std::function<bool()>& condition, double seconds = 20.0);
  // The same, no longer than the engagement lasts.
  std::string waitWhileEngaged(const char* what, const std::function<bool()>& condition);

  const std::string none_;
  aesop::Kinematics kinematics_{aesop::KinematicsConfig()};
  aesop::JointVector home_;  // where the region is selected
  aesop::JointVector marked_;
  double marked_at_ = 0.0;
  ros::NodeHandle node_;
  std::optional<ControllerState> state_;
  std::optional<Homography> homography_;
  const FeatureTask* by_features_ = nullptr;  // null: by the region of interest
  std::optional<TrackedFeatures> features_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace laparoscope_servo::test
