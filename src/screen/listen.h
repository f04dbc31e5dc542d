// Subscribes so that no message can end the screen.
#pragma once

#include <ros/console.h>
#include <ros/node_handle.h>

#include <cstdint>
#include <exception>
#include <string>

namespace laparoscope_servo::screen {

// Exceptions of `take`, which gets the message, are reported.
template <class Message, class Take>
ros::Subscriber listen(ros::NodeHandle& node, const std::string& topic, std::uint32_t queue, const Take& take) {
  const auto callback = [take](const boost::shared_ptr<const Message>& message) {
    try {
      take(*message);
    } catch (const std::exception& error) {
      ROS_WARN_STREAM_THROTTLE(5.0, "a message cannot be shown: " << error.what());
    }
  };
  return node.subscribe<Message>(topic, queue, callback, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
}

}  // namespace laparoscope_servo::screen
