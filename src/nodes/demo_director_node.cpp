// Node `demo_director`: see ros/simulation/demo_director.h. Exit status 0 only when the loop converged.
#include <ros/ros.h>

#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include "ros/common/output_file.h"
#include "ros/common/parameters.h"
#include "ros/simulation/demo_director.h"

using namespace laparoscope_servo;

int main(int argc, char** argv) {
  ros::init(argc, argv, "demo_director");
  ros::NodeHandle node;
  const ros::NodeHandle private_node("~");
  ParameterReader reader(parametersOf(private_node), private_node.getNamespace());
  DemoConfig config;
  reader.readAll(config);
  if (!reader.errors().empty()) {
    ROS_FATAL("%s", reader.report().c_str());
    return EXIT_FAILURE;
  }
  const DemoSummary summary = DemoDirector(node, config).run();
  const std::string text = toJson(summary);
  std::cout << text << std::flush;
  try {
    if (!config.summary.empty()) writeTextFile(config.summary, [&](std::ostream& stream) { stream << text; });
  } catch (const std::runtime_error& error) {
    ROS_FATAL("the summary is lost: %s", error.what());
    return EXIT_FAILURE;
  }
  if (!summary.converged) {
    ROS_FATAL("the loop did not converge: %s", summary.reason.c_str());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
