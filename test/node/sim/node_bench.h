// What the tests of the simulation's nodes share: a temporary directory, nodes as processes, waiting, topics.
#pragma once

#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "support/temporary_folder.h"
#include "system/aesop/child_process.h"

namespace laparoscope_servo::test {

inline std::string contents(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Handles messages until the condition holds; false after `seconds`.
inline bool spinUntil(const std::function<bool()>& condition, double seconds = 20.0) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (ros::spinOnce(), !condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

// Keeps every message of a topic.
template <typename Message>
class Recorder {
 public:
  Recorder(ros::NodeHandle& node, const std::string& topic)
      : subscriber_(node.subscribe<Message>(
            topic, 1000, [this](const typename Message::ConstPtr& message) { all.push_back(message); })) {}
  bool connected() const { return subscriber_.getNumPublishers() > 0; }

  std::vector<typename Message::ConstPtr> all;

 private:
  ros::Subscriber subscriber_;
};

}  // namespace laparoscope_servo::test
