// The messages from other nodes, and which of them the controller accepts.
//
// Each topic has one owner (input_owner.h), each stamp its range (stamp_gate.h). Refused messages are counted and
// reported. While engaged, the owner's name on another connection ends the engagement, and so does a report that the
// robot was stopped, even if a later report precedes the next step.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <geometry_msgs/TwistStamped.h>
#include <laparoscope_servo/OperatingState.h>
#include <laparoscope_servo/ScopeVelocity.h>
#include <laparoscope_servo/TaskError.h>
#include <laparoscope_servo/TrackedFeatures.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Empty.h>

#include <functional>
#include <limits>
#include <string>

#include "laparoscope_servo/servo/controller.h"
#include "laparoscope_servo/servo/dead_man_switch.h"
#include "ros/common/input_owner.h"
#include "ros/common/stamp_gate.h"
#include "ros/common/stamp_watch.h"
#include "ros/controller/controller_parameters.h"
#include "ros/controller/feature_camera.h"
#include "ros/controller/object_place.h"
#include "ros/controller/points_input.h"
#include "ros/controller/position_input.h"
#include "ros/controller/tip_input.h"

namespace laparoscope_servo {

class ControllerInputs {
 public:
  struct Calls {
    std::function<void()> check_time;                     // called before a stamp is compared with ROS time
    std::function<void(const std::string& sender)> stop;  // called when a node stops the arm
    // Rotation from a frame's axes to the shaft's; empty: unknown.
    std::function<std::optional<Eigen::Quaterniond>(const std::string& frame)> shaft_from;
    std::function<const servo::DepthInput&()> depth;  // of the last step
    std::function<void()> step;  // called when a message has ended what moves the arm, not to wait for the next step
  };

  // Subscribes.
  ControllerInputs(ros::NodeHandle& node, ros::NodeHandle& private_node, const ControllerNodeConfig& config,
                   const Calls& calls);

  // Call after each step of the controller and each request to it.
  void know(bool engaged, servo::Task task);
  // Call when engaging.
  void engaging() { dead_man_.engaging(); }
  // Call when ROS time jumped back: old stamps are not comparable any more.
  void forgetStamps();

  // Fills in all but depth and clocks, with the events since the last taken().
  void fill(servo::ControllerInput& input, double steady_now) const;
  void taken();

  // Diagnostics: owners, publishers, and numbers of refused messages. WARN if other nodes publish.
  void describe(diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  // A topic, its owner, and its stamp gate.
  struct Input {
    Input(const std::string& name, const std::string& what, const std::string& parameter, double tolerance)
        : owner(name, what, parameter), stamps(tolerance) {}
    InputOwner owner;
    StampGate stamps;
    ros::Subscriber subscriber;
    double next_complaint = 0.0;  // s, steady
    bool several = false;         // several publishers were reported
  };

  // What a tracker says of the picture, and its age.
  struct PictureWords {
    const char* name;
    const char* none;
    const char* without_stamp;
    const char* jumped_back;
  };
  struct Picture {
    explicit Picture(const PictureWords& said) : words(said) { forget(); }
    void forget();
    PictureWords words;
    servo::TaskErrorInput last;
    StampWatch watch;
  };

  bool counts(Input& input, const std::string& publisher, const InputOwner::Connection& connection, bool matters);
  template <typename Message>
  bool counts(Input& input, const ros::MessageEvent<Message const>& event, bool matters) {
    return counts(input, event.getPublisherName(), event.getConnectionHeaderPtr(), matters);
  }
  bool manualMatters() const { return engaged_ && task_ == servo::Task::kManual; }
  bool isAhead(Input& input, const ros::Time& stamp) const;
  template <typename Message>
  bool takes(Input& input, Picture& picture, const ros::MessageEvent<Message const>& event, bool follows);
  void keep(Picture& picture, const servo::TaskErrorInput& seen);
  // Whether the task error says that the region is not seen in the homography's image, or in a newer one.
  static bool isDenied(const Picture& position, const Picture& task_error);
  static servo::TaskErrorInput agedOf(const Input& input, const Picture& picture, double steady_now);
  void onTaskError(const ros::MessageEvent<TaskError const>& event);
  void onHomography(const ros::MessageEvent<Homography const>& event);
  void onMotion(const ros::MessageEvent<TrackedFeatures const>& event);
  void onPoints(const ros::MessageEvent<TrackedFeatures const>& event);
  void onInstrument(const ros::MessageEvent<TrackedFeatures const>& event);
  void onCameraInfo(const ros::MessageEvent<sensor_msgs::CameraInfo const>& event);
  void onOperatingState(const ros::MessageEvent<OperatingState const>& event);
  void onMeasuredVelocity(const ros::MessageEvent<geometry_msgs::TwistStamped const>& event);
  void onManual(const ros::MessageEvent<ScopeVelocity const>& event);
  void onDeadMan(const ros::MessageEvent<std_msgs::Bool const>& event);
  void onStop(const ros::MessageEvent<std_msgs::Empty const>& event);
  void end(const std::string& why);
  static void describe(Input& input, diagnostic_updater::DiagnosticStatusWrapper& status);

  ControllerNodeConfig config_;
  Calls calls_;
  bool engaged_ = false;
  servo::Task task_ = servo::Task::kHoldView;
  std::string ended_;       // reason that has ended the engagement since taken()
  std::string clock_jump_;  // clock jump since taken()

  Input task_error_input_;
  Input homography_input_;
  Input motion_input_;
  Input instrument_input_;
  Input points_input_;
  Input camera_info_input_;
  Input operating_state_input_;
  Input measured_velocity_input_;
  Input manual_input_;
  Input dead_man_input_;
  ros::Subscriber stop_subscriber_;

  Picture task_error_{
      {"task error", "no task error was received", "task error has no stamp", "stamps of the task error jumped back"}};
  Picture view_{{"motion of the view", "no motion of the view was received", "motion of the view has no stamp",
                 "stamps of the motion of the view jumped back"}};
  Picture tip_{{"tip of an instrument", "no tip of an instrument was received", "tip of an instrument has no stamp",
                "stamps of the tip of an instrument jumped back"}};
  Picture object_{{"motion of the object", "no motion of the object was received", "motion of the object has no stamp",
                   "stamps of the motion of the object jumped back"}};
  Picture points_{{"points of the view", "no points of the view were received", "points of the view have no stamp",
                   "stamps of the points of the view jumped back"}};
  Picture position_{{"homography of the region", "no homography of the region was received",
                     "homography of the region has no stamp", "stamps of the homography of the region jumped back"}};
  FeatureCamera camera_;
  ObjectPlace object_place_;
  PointsInput points_error_;
  PositionInput position_input_;
  TipInput tip_input_;
  servo::RobotFacts robot_;
  ros::Time robot_stamp_;
  double robot_arrival_ = 0.0;  // s, steady
  ScopeVelocity manual_;
  double manual_arrival_ = -std::numeric_limits<double>::infinity();  // s, steady
  servo::DeadManSwitch dead_man_;
  servo::RobotReport robot_report_;
  double robot_report_arrival_ = 0.0;  // s, steady, arrival of that report
};

}  // namespace laparoscope_servo
