// Lets a node finish what it has to do before ROS closes its publishers: roscpp's own handler closes them inside the
// signal, and a last command of zero would never leave.
#pragma once

namespace laparoscope_servo::skin {

// Turns SIGINT, SIGTERM, SIGHUP and `rosnode kill` into a request. Call it after ros::init with NoSigintHandler and
// after the first NodeHandle was made: until there is a master, a signal simply ends the process.
void catchStopRequests();

// Somebody asked the process to end.
bool stopRequested();

}  // namespace laparoscope_servo::skin
