// Lets a node finish its work before ROS closes its publishers: roscpp's own handler closes them inside the signal
// handler, so that a last zero command would never be sent. Also handles a signal that stops the arm, but not the node.
#pragma once

namespace laparoscope_servo {

// Turns SIGINT, SIGTERM, SIGHUP and `rosnode kill` into a request. Call it after ros::init with NoSigintHandler and
// after constructing the first NodeHandle; before, while waiting for a master, a signal simply ends the process.
void catchStopRequests();

// Whether the process was asked to end.
bool stopRequested();

// Whether SIGUSR1 has come since the last call: the arm must stop, the process goes on. Works after
// catchStopRequests(); before it, the signal ends the process.
bool takeHaltRequest();

// Call before unregistering from the master, for which roscpp would wait for ever if the master does not answer. After
// a moment the process ends with `status` in any case.
void limitFarewell(int status);

}  // namespace laparoscope_servo
