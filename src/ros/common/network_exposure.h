// Checks whether this process listens to other machines without being configured for it. ROS 1 has no authentication:
// doc/network.md.
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo {

// Addresses, with ports, other than loopback on which this process accepts TCP connections, from /proc.
std::vector<std::string> addressesBeyondLoopback();

// Whether the environment is set for several machines: ROS_HOSTNAME or ROS_IP are not loopback, or the master is
// elsewhere. `master`: the master's host.
bool spreadOverMachines(const std::string& master);

// The warning; empty if nothing listens, or if the environment is set for it.
std::string exposureWarning(const std::string& master);

// Logs exposureWarning(), for a node that has registered with its master.
void warnOfExposure();

}  // namespace laparoscope_servo
