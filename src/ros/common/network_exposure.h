// Does this process listen to other machines though nobody asked for it? ROS 1 asks nobody who he is: doc/network.md.
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo {

// Addresses, with ports, beyond the loopback one on which this process takes TCP connections. By /proc.
std::vector<std::string> addressesBeyondLoopback();

// Whether the environment tells of other machines: ROS_HOSTNAME or ROS_IP not of loopback, or a master elsewhere.
// `master`: the master's host.
bool spreadOverMachines(const std::string& master);

// What to warn of; empty when nothing listens, or when it was asked for.
std::string exposureWarning(const std::string& master);

// The same as a line of the log, for a node that has registered with its master.
void warnOfExposure();

}  // namespace laparoscope_servo
