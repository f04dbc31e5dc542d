// Node `aesop`: drives the arm over a serial port. See doc/nodes/aesop.md.
#include "ros/aesop/aesop_node.h"

#include <ros/ros.h>

#include <exception>

#include "nodes/robot_node.h"
#include "ros/common/frame_names.h"
#include "ros/common/network_exposure.h"
#include "ros/common/stop_request.h"

namespace {

int run() {
  using namespace laparoscope_servo;
  const ros::NodeHandle node;
  const ros::NodeHandle private_node("~");
  catchStopRequests();
  ParameterReader reader(parametersOf(private_node), private_node.getNamespace());
  AesopParameters parameters = readAesopParameters(reader);
  if (!reader.errors().empty()) {
    ROS_FATAL_STREAM(reader.report());
    return 1;
  }
  parameters.frame_prefix = framePrefix(parameters.frame_prefix, node.getNamespace());
  AesopNode aesop(node, private_node, parameters);
  warnOfExposure();
  int status = 0;
  try {
    aesop.run(stopRequested);
  } catch (const std::exception&) {  // logged by run()
    status = 1;
  }
  limitFarewell(status);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  return laparoscope_servo::robotNode(argc, argv, "aesop", run);
}
