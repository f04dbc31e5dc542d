// The tracker as a node of its own: a manager with one nodelet in it.
#include <nodelet/loader.h>
#include <ros/ros.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "laparoscope_servo/ros/parameters.h"
#include "laparoscope_servo/ros/tracker_parameters.h"
#include "laparoscope_servo/ros/unblocked_output.h"

int main(int argc, char** argv) {
  const laparoscope_servo::skin::UnblockedOutput output;
  ros::init(argc, argv, "tracker");
  {
    // The nodelet would stand aside to spare its manager. A node of its own says so by its exit status.
    const ros::NodeHandle node("~");
    std::vector<std::string> errors;
    laparoscope_servo::skin::readTrackerParameters(laparoscope_servo::skin::parametersOf(node), node.getNamespace(),
                                                   errors);
    if (!errors.empty()) {
      ROS_FATAL("%s", laparoscope_servo::skin::errorReport(errors).c_str());
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
