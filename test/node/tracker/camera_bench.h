// A camera and the listeners of one tracker, for tests against the running node.
#pragma once

#include <cv_bridge/cv_bridge.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PolygonStamped.h>
#include <gtest/gtest.h>
#include <laparoscope_servo/AreaSelection.h>
#include <laparoscope_servo/CheckRoi.h>
#include <laparoscope_servo/FreezeImage.h>
#include <laparoscope_servo/Homography.h>
#include <laparoscope_servo/SelectRoi.h>
#include <laparoscope_servo/StoredView.h>
#include <laparoscope_servo/TaskError.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_srvs/Trigger.h>

#include <chrono>
#include <functional>
#include <future>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "laparoscope_servo/geometry/homography.h"
#include "support/ros_tests.h"
#include "support/synthetic_sequence.h"

namespace laparoscope_servo::test_support {

inline bool waitFor(const std::function<bool()>& condition, double seconds = 20.0) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > until || !ros::ok()) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

// The newest message of a topic for each stamp; other threads write.
template <class Message>
class Inbox {
 public:
  Inbox(ros::NodeHandle& node, const std::string& topic)
      : subscriber_(node.subscribe<Message>(topic, 100, [this](const boost::shared_ptr<const Message>& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          messages_[message->header.stamp] = message;
        })) {}

  boost::shared_ptr<const Message> at(const ros::Time& stamp) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = messages_.find(stamp);
    return found == messages_.end() ? nullptr : found->second;
  }
  boost::shared_ptr<const Message> waitFor(const ros::Time& stamp) const {
    test_support::waitFor([&] { return at(stamp) != nullptr; });
    return at(stamp);
  }
  bool connected() const { return subscriber_.getNumPublishers() > 0; }
  void clear() {
    const std::lock_guard<std::mutex> lock(mutex_);
    messages_.clear();
  }

 private:
  mutable std::mutex mutex_;
  std::map<ros::Time, boost::shared_ptr<const Message>> messages_;
  ros::Subscriber subscriber_;
};

class CameraBench {
 public:
  // The tracker `space`/tracker, which subscribes `space`/image and `space`/camera_info.
  explicit CameraBench(const std::string& space)
      : node_(space),
        homographies(node_, "tracker/homography"),
        task_errors(node_, "tracker/task_error"),
        images_(node_.advertise<sensor_msgs::Image>("image", 10)),
        infos_(node_.advertise<sensor_msgs::CameraInfo>("camera_info", 1)) {}

  bool ready() const {
    return waitFor([this] {
      return images_.getNumSubscribers() > 0 && infos_.getNumSubscribers() > 0 && homographies.connected() &&
             task_errors.connected();
    });
  }

  static std_msgs::Header header(const ros::Time& stamp) {
    std_msgs::Header result;
    result.frame_id = "optical_of_the_test";
    result.stamp = stamp;
    return result;
  }

  void publish(const sensor_msgs::Image& image) { images_.publish(image); }

  // Publishes an image and waits for the tracker's answer; null when there is none.
  HomographyConstPtr track(const cv::Mat& image, const ros::Time& stamp) {
    send(image, stamp);
    return homographies.waitFor(stamp);
  }

  // Without noise it would be one that repeats.
  sensor_msgs::ImagePtr message(const cv::Mat& image, const ros::Time& stamp) {
    const std::string encoding = image.channels() == 1 ? "mono8" : "bgr8";
    return cv_bridge::CvImage(header(stamp), encoding, noisy(image, random_)).toImageMsg();
  }
  void send(const cv::Mat& image, const ros::Time& stamp) { images_.publish(message(image, stamp)); }

  void publishInfo(double focal_length, unsigned width = 0, unsigned height = 0) {
    sensor_msgs::CameraInfo info;
    info.width = width;
    info.height = height;
    info.K = {focal_length, 0.0, 160.0, 0.0, focal_length, 120.0, 0.0, 0.0, 1.0};
    infos_.publish(info);
  }

  void publishInfo(const sensor_msgs::CameraInfo& info) { infos_.publish(info); }

  // Calls the service in a thread of its own: it answers when an image has come.
  std::future<SelectRoiResponse> select(const geometry::Rectangle& roi) {
    SelectRoi call;
    call.request.roi.x_offset = static_cast<std::uint32_t>(roi.x);
    call.request.roi.y_offset = static_cast<std::uint32_t>(roi.y);
    call.request.roi.width = static_cast<std::uint32_t>(roi.width);
    call.request.roi.height = static_cast<std::uint32_t>(roi.height);
    const std::string name = node_.resolveName("tracker/select_roi");
    return std::async(std::launch::async, [call, name]() mutable {
      ros::service::waitForService(name, 10000);
      if (!ros::service::call(name, call)) call.response.message = "the service call failed";
      return call.response;
    });
  }

  // The same for store_view and recall_view.
  std::future<StoredViewResponse> askForView(const std::string& service, const std::string& view) {
    StoredView call;
    call.request.name = view;
    const std::string name = node_.resolveName("tracker/" + service);
    return std::async(std::launch::async, [call, name]() mutable {
      ros::service::waitForService(name, 10000);
      if (!ros::service::call(name, call)) call.response.message = "the service call failed";
      return call.response;
    });
  }

  // Any other service of the tracker that waits for an image.
  template <class Service>
  std::future<typename Service::Response> ask(const std::string& service, const typename Service::Request& request) {
    Service call;
    call.request = request;
    const std::string name = node_.resolveName("tracker/" + service);
    return std::async(std::launch::async, [call, name]() mutable {
      ros::service::waitForService(name, 10000);
      ros::service::call(name, call);
      return call.response;
    });
  }

  bool reset() {
    std_srvs::Trigger call;
    const std::string name = node_.resolveName("tracker/reset");
    return ros::service::waitForService(name, 10000) && ros::service::call(name, call) && call.response.success;
  }

  ros::NodeHandle& node() { return node_; }

 private:
  ros::NodeHandle node_;

 public:
  Inbox<Homography> homographies;
  Inbox<TaskError> task_errors;

 private:
  cv::RNG random_{7};
  ros::Publisher images_;
  ros::Publisher infos_;
};

// What a tracker last said on /diagnostics.
class DiagnosticsListener {
 public:
  DiagnosticsListener(ros::NodeHandle& node, const std::string& tracker)
      : subscriber_(node.subscribe<diagnostic_msgs::DiagnosticArray>(
            "/diagnostics", 100, [this, tracker](const diagnostic_msgs::DiagnosticArrayConstPtr& message) {
              const std::lock_guard<std::mutex> lock(mutex_);
              for (const auto& status : message->status) {
                if (status.name.find(tracker) != std::string::npos) last_ = status;
              }
            })) {}

  diagnostic_msgs::DiagnosticStatus last() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return last_;
  }
  // Empty when it has no such key.
  std::string value(const std::string& key) const {
    for (const diagnostic_msgs::KeyValue& value : last().values) {
      if (value.key == key) return value.value;
    }
    return "";
  }
  bool waitForMessage(int level, const std::string& part) const {
    return waitFor([&] { return last().level == level && last().message.find(part) != std::string::npos; });
  }

 private:
  mutable std::mutex mutex_;
  diagnostic_msgs::DiagnosticStatus last_;
  ros::Subscriber subscriber_;
};

}  // namespace laparoscope_servo::test_support
