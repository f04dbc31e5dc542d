#include "stranger.h"

#include <geometry_msgs/TwistStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Bool.h>
#include <tf2_msgs/TFMessage.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <stdexcept>

#include "laparoscope_servo/Homography.h"
#include "laparoscope_servo/OperatingState.h"
#include "laparoscope_servo/ScopeVelocity.h"
#include "laparoscope_servo/TaskError.h"
#include "laparoscope_servo/TrackedFeatures.h"

namespace laparoscope_servo::test {

namespace {

std::atomic<bool> begun{false};

void onSignal(int) {
  begun = true;
}

// A region that is elsewhere: far to the right, valid, fresh.
TaskError elsewhere() {
  TaskError error;
  error.header.stamp = ros::Time::now();
  error.header.frame_id = "laparoscope_optical";
  error.valid = static_cast<std::uint8_t>(true);
  error.reference_stamp = ros::Time(1.0);
  error.x = 0.3;
  error.e_v.x = 0.3;
  error.m_star.z = 1.0;
  error.visible_fraction = 1.0;
  error.corner_error = 0.1;
  return error;
}

TrackedFeatures seenFeatures() {
  TrackedFeatures features;
  features.header.stamp = ros::Time::now();
  features.selection_stamp = ros::Time(1.0);
  features.state = TrackedFeatures::TRACKING;
  features.width = 640;
  features.height = 480;
  return features;
}

// An object far to the right.
TrackedFeatures objectElsewhere() {
  TrackedFeatures features = seenFeatures();
  TrackedFeature& object = features.features.emplace_back();
  object.id = "object";
  object.kind = TrackedFeature::MOTION;
  object.state = TrackedFeatures::TRACKING;
  object.share = 1.0;
  object.expected_error = 0.05;
  object.parameters = {0.0, 0.0};
  object.outline = {500.0, 200.0, 580.0, 200.0, 580.0, 280.0, 500.0, 280.0, 500.0, 200.0};
  return features;
}

// Points that are all 100 px to the right of their places.
TrackedFeatures pointsElsewhere() {
  TrackedFeatures features = seenFeatures();
  for (int k = 0; k < 12; ++k) {
    TrackedFeature& point = features.features.emplace_back();
    point.id = "tissue " + std::to_string(k + 1);
    point.kind = TrackedFeature::POINT;
    point.state = TrackedFeatures::TRACKING;
    point.share = 1.0;
    point.expected_error = 0.1;
    point.desired = {200.0 + 60.0 * (k % 4), 150.0 + 60.0 * (k / 4)};
    point.parameters = {point.desired[0] + 100.0, point.desired[1]};
  }
  return features;
}

// A region far to the right.
Homography homographyElsewhere() {
  Homography message;
  message.header.stamp = ros::Time::now();
  message.reference_stamp = ros::Time(1.0);
  message.state = Homography::TRACKING;
  message.has_intrinsics = 1;
  message.g = {1.0, 0.0, 120.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  message.h = {1.0, 0.0, 0.3, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  message.visible_fraction = 1.0;
  message.corner_error = 0.1;
  return message;
}

OperatingState enabled() {
  OperatingState state;
  state.header.stamp = ros::Time::now();
  state.state = OperatingState::_state_type("ENABLED");
  state.is_homed = static_cast<std::uint8_t>(true);
  return state;
}

ScopeVelocity velocity(double pan) {
  ScopeVelocity message;
  message.header.stamp = ros::Time::now();
  message.pan = pan;
  return message;
}

sensor_msgs::Image grey() {
  sensor_msgs::Image image;
  image.header.stamp = ros::Time::now();
  image.header.frame_id = "laparoscope_optical";
  image.width = 640;
  image.height = 480;
  image.encoding = "bgr8";
  image.step = 3 * image.width;
  image.data.resize(static_cast<std::size_t>(image.step) * image.height);
  for (std::size_t k = 0; k < image.data.size(); ++k) image.data[k] = static_cast<std::uint8_t>(k * k / 977);
  return image;
}

sensor_msgs::CameraInfo intrinsics() {
  sensor_msgs::CameraInfo info;
  info.header.stamp = ros::Time::now();
  info.header.frame_id = "laparoscope_optical";
  info.width = 640;
  info.height = 480;
  info.K = {800.0, 0.0, 319.5, 0.0, 800.0, 239.5, 0.0, 0.0, 1.0};
  info.P = {800.0, 0.0, 319.5, 0.0, 0.0, 800.0, 239.5, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

geometry_msgs::TransformStamped transform(const std::string& parent, const std::string& child, double z) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = ros::Time::now();
  message.header.frame_id = parent;
  message.child_frame_id = child;
  message.transform.translation.z = z;
  message.transform.rotation.w = 1.0;
  return message;
}

tf2_msgs::TFMessage frame(const std::string& parent, const std::string& child, double z) {
  tf2_msgs::TFMessage message;
  message.transforms.push_back(transform(parent, child, z));
  return message;
}

geometry_msgs::TwistStamped measured(double pan) {
  geometry_msgs::TwistStamped message;
  message.header.stamp = ros::Time::now();
  message.header.frame_id = "laparoscope_optical";
  message.twist.angular.y = pan;
  return message;
}

template <typename Message>
int publish(const std::string& topic, double rate, const std::function<Message()>& make, const std::string& ready) {
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<Message>(topic, 1);
  ROS_INFO_STREAM("publishes on " << topic);
  while (ros::ok() && publisher.getNumSubscribers() == 0) ros::WallDuration(0.005).sleep();
  std::ofstream(ready) << "ready\n";
  while (ros::ok() && !begun) ros::WallDuration(0.001).sleep();
  for (ros::WallRate pace(rate); ros::ok(); pace.sleep()) publisher.publish(make());
  return 0;
}

}  // namespace

Stranger::Stranger(AesopBench& bench, const std::string& topic, const std::string& what, double rate) {
  static int count = 0;
  const std::string ready = bench.file("stranger_" + std::to_string(++count));
  process_ = std::make_unique<ChildProcess>(
      "/proc/self/exe", std::vector<std::string>{"stranger", topic, what, std::to_string(rate), ready,
                                                 "__name:=stranger_" + std::to_string(count)});
  if (!bench.waitFor([&] { return std::ifstream(ready).good(); }, 10.0)) {
    throw std::runtime_error("nobody listens to a stranger on " + topic);
  }
}

int runStranger(int argc, char** argv) {
  ros::init(argc, argv, "stranger");
  ::signal(SIGUSR2, onSignal);
  if (argc < 6) return 2;
  const std::string topic = argv[2], what = argv[3], ready = argv[5];
  const double rate = std::stod(argv[4]);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::map<std::string, std::function<int()>> words{
      {"elsewhere", [&] { return publish<TaskError>(topic, rate, elsewhere, ready); }},
      {"object_elsewhere", [&] { return publish<TrackedFeatures>(topic, rate, objectElsewhere, ready); }},
      {"points_elsewhere", [&] { return publish<TrackedFeatures>(topic, rate, pointsElsewhere, ready); }},
      {"homography_elsewhere", [&] { return publish<Homography>(topic, rate, homographyElsewhere, ready); }},
      {"enabled", [&] { return publish<OperatingState>(topic, rate, enabled, ready); }},
      {"velocity",
       [&] {
         return publish<ScopeVelocity>(
             topic, rate, [] { return velocity(-0.1); }, ready);
       }},
      {"velocity_nan",
       [&] {
         return publish<ScopeVelocity>(
             topic, rate, [&] { return velocity(nan); }, ready);
       }},
      {"measured",
       [&] {
         return publish<geometry_msgs::TwistStamped>(
             topic, rate, [] { return measured(-0.1); }, ready);
       }},
      {"pressed",
       [&] {
         return publish<std_msgs::Bool>(
             topic, rate,
             [] {
               std_msgs::Bool pressed;
               pressed.data = static_cast<std::uint8_t>(true);
               return pressed;
             },
             ready);
       }},
      {"grey", [&] { return publish<sensor_msgs::Image>(topic, rate, grey, ready); }},
      {"intrinsics", [&] { return publish<sensor_msgs::CameraInfo>(topic, rate, intrinsics, ready); }},
      {"tip_off",
       [&] {
         return publish<tf2_msgs::TFMessage>(
             topic, rate, [] { return frame("scope_tip", "laparoscope_optical", 0.05); }, ready);
       }},
      {"tip_nan",
       [&] {
         return publish<tf2_msgs::TFMessage>(
             topic, rate, [&] { return frame("scope_tip", "laparoscope_optical", nan); }, ready);
       }},
      {"shaft_off",
       [&] {
         return publish<tf2_msgs::TFMessage>(
             topic, rate, [] { return frame("end_effector", "scope_tip", 0.35); }, ready);
       }},
      {"trocar_off",
       [&] {
         return publish<tf2_msgs::TFMessage>(
             topic, rate, [] { return frame("aesop_base", "insertion_point", 0.05); }, ready);
       }},
  };
  const auto word = words.find(what);
  return word == words.end() ? 2 : word->second();
}

}  // namespace laparoscope_servo::test
