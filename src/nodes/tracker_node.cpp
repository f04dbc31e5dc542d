// The tracker as a separate node: a manager with one nodelet.
#include <nodelet/loader.h>
#include <ros/ros.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "ros/common/parameters.h"
#include "ros/common/unblocked_output.h"
#include "ros/tracker/tracker_parameters.h"

int main(int argc, char** argv) {
  const laparoscope_servo::UnblockedOutput output;
  ros::init(argc, argv, "tracker");
  {
    // With wrong parameters the nodelet stays inactive to keep its manager running; a separate node ends with an exit
    // status instead.
    const ros::NodeHandle node("~");
    std::vector<std::string> errors;
    laparoscope_servo::readTrackerParameters(laparoscope_servo::parametersOf(node), node.getNamespace(), errors);
    if (!errors.empty()) {
      ROS_FATAL("%s", laparoscope_servo::errorReport(errors).c_str());
      return EXIT_FAILURE;
    }
  }
  nodelet::Loader loader(false);
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (!loader.load(ros::this_node::getName(), "laparoscope_servo/Tracker", ros::names::getRemappings(), arguments)) {
    ROS_FATAL("the nodelet laparoscope_servo/Tracker cannot be loaded");
    return EXIT_FAILURE;
  }
  ros::spin();
  return EXIT_SUCCESS;
}
