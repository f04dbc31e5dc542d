// Stands in for a controller: commands a pan of ~pan rad/s at 25 Hz until it is killed.
#include <ros/ros.h>

#include "laparoscope_servo/ScopeVelocity.h"

int main(int argc, char** argv) {
  ros::init(argc, argv, "command_publisher");
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<laparoscope_servo::ScopeVelocity>("servo_command", 1);
  const double pan = ros::param::param("~pan", 0.05);
  ros::WallRate rate(25.0);
  while (ros::ok()) {
    laparoscope_servo::ScopeVelocity command;
    command.header.stamp = ros::Time::now();
    command.pan = pan;
    publisher.publish(command);
    rate.sleep();
  }
  return 0;
}
