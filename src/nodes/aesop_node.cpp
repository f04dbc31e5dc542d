// Node `aesop`: drives the arm over a serial port. See doc/nodes/aesop.md.
#include "laparoscope_servo/ros/aesop_node.h"

#include <ros/ros.h>

#include <exception>

#include "laparoscope_servo/ros/frame_names.h"
#include "laparoscope_servo/ros/network_exposure.h"
#include "laparoscope_servo/ros/stop_request.h"
#include "laparoscope_servo/ros/unblocked_output.h"

namespace {

int run() {
  using namespace laparoscope_servo;
  const ros::NodeHandle node;
  const ros::NodeHandle private_node("~");
  skin::catchStopRequests();
  skin::ParameterReader reader(skin::parametersOf(private_node), private_node.getNamespace());
  skin::AesopParameters parameters = skin::readAesopParameters(reader);
  if (!reader.errors().empty()) {
    ROS_FATAL_STREAM(reader.report());
    return 1;
  }
  parameters.frame_prefix = skin::framePrefix(parameters.frame_prefix, node.getNamespace());
  skin::AesopNode aesop(node, private_node, parameters);
  skin::warnOfExposure();
  int status = 0;
  try {
    aesop.run(skin::stopRequested);
  } catch (const std::exception&) {  // said by run()
    status = 1;
  }
  skin::limitFarewell(status);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  const laparoscope_servo::skin::UnblockedOutput output;
  // No handler of ROS: the arm has to be disabled while there is still a node to do it.
  ros::init(argc, argv, "aesop", ros::init_options::NoSigintHandler);
  int status = 1;
  try {
    status = run();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
  }
  ros::shutdown();
  return status;
}
