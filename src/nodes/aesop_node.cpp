// Node `aesop`: drives the arm over a serial port. See README, node `aesop`.
#include "laparoscope_servo/ros/aesop_node.h"

#include <ros/ros.h>

#include <csignal>
#include <exception>

namespace {

std::atomic<bool> stop{false};

void onSignal(int) {
  stop = true;
}

int run() {
  const ros::NodeHandle node;
  const ros::NodeHandle private_node("~");
  using namespace laparoscope_servo;
  skin::ParameterReader reader(skin::parametersOf(private_node), private_node.getNamespace());
  const skin::AesopParameters parameters = skin::readAesopParameters(reader);
  if (!reader.errors().empty()) {
    ROS_FATAL_STREAM(reader.report());
    return 1;
  }
  skin::AesopNode(node, private_node, parameters).run(stop);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  // Own handlers: the arm has to be disabled while there is still a node to do it.
  ros::init(argc, argv, "aesop", ros::init_options::NoSigintHandler);
  std::signal(SIGINT, onSignal);
  std::signal(SIGTERM, onSignal);
  std::signal(SIGHUP, onSignal);
  int status = 1;
  try {
    status = run();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
  }
  ros::shutdown();
  return status;
}
