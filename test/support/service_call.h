// A call of a service with a deadline. ros::service::call() waits for as long as a process that was stopped, or that
// hangs, keeps its connection.
#pragma once

#include <ros/ros.h>

#include <chrono>
#include <future>
#include <string>

namespace laparoscope_servo::test_support {

constexpr double kServiceTime = 5.0;  // s; on a busy machine an answer takes a second at most

// False when the service is not there or has not answered within `seconds`; the call is then taken back.
template <typename Service>
bool callWithin(const std::string& name, Service& call, double seconds = kServiceTime) {
  // A client that is persistent has a connection that can be closed beneath a call.
  ros::ServiceClient client = ros::NodeHandle().serviceClient<Service>(name, true);
  std::future<bool> answered = std::async(std::launch::async, [&] { return client.call(call); });
  while (answered.wait_for(std::chrono::duration<double>(seconds)) != std::future_status::ready) client.shutdown();
  return answered.get();
}

}  // namespace laparoscope_servo::test_support
