// The node `simulated_camera`: renders the view of the laparoscope held by the emulated arm, and publishes it like a
// camera driver.
//
// Publishes: image_raw (sensor_msgs/Image, bgr8) and camera_info, stamped with the time of the arm's pose that the
// image was made from; ~tissue (visualization_msgs/Marker, latched) and ~instrument (visualization_msgs/MarkerArray),
// for rviz, in aesop_base. Services: ~cross_instrument (std_srvs/Trigger): the instrument crosses the picture once,
// from now. While the emulator cannot be reached it publishes nothing, logs that, and tries again.
#pragma once

#include <image_transport/image_transport.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <std_srvs/Trigger.h>

#include <memory>
#include <optional>
#include <string>

#include "laparoscope_servo/aesop/kinematics.h"
#include "laparoscope_servo/parameters/table.h"
#include "laparoscope_servo/sim/emulator.h"
#include "laparoscope_servo/sim/emulator_control_client.h"
#include "laparoscope_servo/sim/scope_camera.h"

namespace laparoscope_servo {

struct SimulatedCameraConfig {
  std::string control;                           // path of the emulator's control socket; required
  std::string frame_prefix = "auto";             // in front of frames without a slash, see frame_names.h
  std::string frame_id = "laparoscope_optical";  // of the images
  std::string base_frame = "aesop_base";         // of the markers
  sim::SceneConfig scene;                        // config/simulation.yaml
  sim::EmulatorConfig emulator;                  // config/aesop.yaml, kinematics, and config/emulator.yaml
};

// Adds the rows of the private parameters.
void describe(parameters::Table& table, SimulatedCameraConfig& config);
// Without what the emulator has, too.
void describeCamera(parameters::Table& table, SimulatedCameraConfig& config);
std::vector<std::string> validate(const SimulatedCameraConfig& config);

class SimulatedCamera {
 public:
  // Throws std::invalid_argument or std::runtime_error if the start pose is impossible, or the texture cannot be read.
  SimulatedCamera(ros::NodeHandle node, ros::NodeHandle private_node, const SimulatedCameraConfig& config);

  // Publishes at the camera's rate until the node ends.
  void run();

 private:
  struct Pose {
    Eigen::Isometry3d base_T_camera;
    ros::Time stamp;
  };

  // The camera's present pose; empty if the emulator does not answer.
  std::optional<Pose> pose();
  void publishImage(const Pose& pose);
  std::optional<Eigen::Vector3d> instrumentTip(double now);
  void publishInstrument(const std::optional<Eigen::Vector3d>& tip);
  bool crossInstrument(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  SimulatedCameraConfig config_;
  aesop::Kinematics kinematics_;
  sim::ScopeCamera camera_;
  sensor_msgs::CameraInfo camera_info_;
  std::unique_ptr<sim::EmulatorControlClient> emulator_;
  std::optional<double> crossing_;  // s, ROS time: when the latest crossing began
  bool instrument_shown_ = false;
  image_transport::ImageTransport transport_;
  image_transport::CameraPublisher publisher_;
  ros::Publisher tissue_publisher_;
  ros::Publisher instrument_publisher_;
  ros::ServiceServer cross_service_;
};

}  // namespace laparoscope_servo
