// A restarted ROS master does not know the running processes. Registers all publishers and subscribers of this process
// again; open connections stay open.
#pragma once

#include <atomic>
#include <string>

#include "ros/common/master_client.h"

namespace laparoscope_servo::screen {

class Registration {
 public:
  // Construct it after ros::start.
  Registration();

  // Asks the master for its process id, for half a second at most, and registers again with a new master. Returns true
  // if it did. The first call, before anything is published, only stores the id. `ending`: stops waiting.
  bool renew(const std::atomic<bool>& ending);

 private:
  int process(const std::atomic<bool>& ending);
  bool isTaken(const std::atomic<bool>& ending);
  void publishers(const std::atomic<bool>& ending);
  void subscribers(const std::atomic<bool>& ending);

  MasterClient client_;
  int process_ = 0;  // of the master; 0: not known yet
};

}  // namespace laparoscope_servo::screen
