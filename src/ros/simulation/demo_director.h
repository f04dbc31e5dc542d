// The node `demo_director`: plays the surgeon and the nurse of the simulated cart once, and measures the loop.
//
// It waits for camera, tracker, controller and arm; selects a ROI in the middle of the image; moves the disabled arm by
// hand away from there, the tracker following; enables and engages; waits until the ROI has come back and stays; lets
// the instrument cross meanwhile; writes a summary as JSON. Relative names: camera/camera_info, tracker/homography,
// aesop/operating_state; services tracker/select_roi, aesop/enable, controller/engage,
// simulated_camera/cross_instrument.
#pragma once

#include <laparoscope_servo/Homography.h>
#include <laparoscope_servo/OperatingState.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>

#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "laparoscope_servo/aesop/kinematics.h"
#include "laparoscope_servo/parameters/table.h"
#include "laparoscope_servo/sim/emulator.h"
#include "laparoscope_servo/sim/emulator_control_client.h"
#include "ros/simulation/demo_measures.h"
#include "ros/simulation/demo_plan.h"

namespace laparoscope_servo {

struct DemoConfig {
  std::string control;            // path of the emulator's control socket; required
  std::string summary;            // file to write; empty: none
  double roi_side = 120.0;        // px
  double pan = 0.14;              // rad: by hand, from the start pose; with the tilt 10 degrees
  double tilt = 0.105;            // rad
  double spin = 0.0;              // rad
  double deeper = 0.02;           // m
  double hand_time = 6.0;         // s: how long the hand takes
  double settled_error = 2.0;     // px: error of the ROI's centre within which it counts as back
  double settled_scale = 0.02;    // relative error of its size
  double settled_time = 2.0;      // s, for which both must stay within
  bool cross_instrument = true;   // once it has settled
  double startup_timeout = 60.0;  // s: for the nodes to be there
  double timeout = 90.0;          // s: for each of the loop's tasks
  sim::EmulatorConfig emulator;   // config/aesop.yaml, kinematics, and config/emulator.yaml
};

// The private parameters.
void describe(parameters::Table& table, DemoConfig& config);
// Without what the emulator has, too.
void describeDirector(parameters::Table& table, DemoConfig& config);
std::vector<std::string> validate(const DemoConfig& config);

class DemoDirector {
 public:
  DemoDirector(ros::NodeHandle node, const DemoConfig& config);

  // Runs the whole demo. The summary's reason holds an error.
  DemoSummary run();

 private:
  // An error that ends the demo.
  class Failed : public std::runtime_error {
   public:
    using std::runtime_error::runtime_error;
  };

  void play();
  void announce(DemoStepIndex step);
  void waitForNodes();
  void selectRoi();
  void moveByHand();
  void closeLoop();
  void crossInstrument();
  void finish();

  // Handles messages until the condition holds. Throws Failed if `what` did not happen within `timeout` s.
  void waitFor(const std::string& what, double timeout, const std::function<bool()>& condition);
  void onHomography(const Homography& message);
  Eigen::Isometry3d truePose();
  PoseError truth();
  // Once more while it is refused, for `patience` s.
  template <typename Service>
  void call(const std::string& name, Service service, double patience = 0.0);

  DemoConfig config_;
  std::vector<DemoStep> steps_;
  ros::NodeHandle node_;
  aesop::Kinematics kinematics_;
  std::unique_ptr<sim::EmulatorControlClient> emulator_;
  ros::Subscriber camera_info_subscriber_;
  ros::Subscriber homography_subscriber_;
  ros::Subscriber state_subscriber_;

  std::optional<sensor_msgs::CameraInfo> camera_info_;
  std::optional<Homography> homography_;
  std::string operating_state_;
  geometry::Rectangle roi_;
  bool selected_ = false;
  bool crossing_ = false;
  ViewError error_;
  Settling settling_;
  Eigen::Isometry3d start_pose_ = Eigen::Isometry3d::Identity();
  DemoSummary summary_;
};

}  // namespace laparoscope_servo
