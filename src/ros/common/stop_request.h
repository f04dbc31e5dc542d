// Lets a node finish what it has to do before ROS closes its publishers: roscpp's own handler closes them inside the
// signal, and a last command of zero would never leave. And a signal that stops the arm, but not the node.
#pragma once

namespace laparoscope_servo {

// Turns SIGINT, SIGTERM, SIGHUP and `rosnode kill` into a request. Call it after ros::init with NoSigintHandler and
// after the first NodeHandle was made: until there is a master, a signal simply ends the process.
void catchStopRequests();

// Somebody asked the process to end.
bool stopRequested();

// Whether SIGUSR1 has come since the last call: the arm is to stop, the process goes on. From catchStopRequests() on;
// before it, the signal ends the process.
bool takeHaltRequest();

// When there is nothing left to do but to say goodbye to the master: roscpp would wait for ever for one that does not
// answer. After a moment the process ends with `status`, whatever it is doing.
void limitFarewell(int status);

}  // namespace laparoscope_servo
