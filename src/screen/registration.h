// After a ROS master was started anew it knows nothing of the processes that go on. This tells it again what this one
// publishes and listens to, all of it; connections that are open stay open.
#pragma once

#include <atomic>
#include <string>

#include "ros/common/master_client.h"

namespace laparoscope_servo::screen {

class Registration {
 public:
  // After ros::start.
  Registration();

  // Asks the master whether it knows this process, for half a second at most, and tells it if it does not. True when it
  // was told. `ending`: gives up.
  bool renew(const std::atomic<bool>& ending);

 private:
  bool isUnknown(const std::atomic<bool>& ending);
  void publishers(const std::atomic<bool>& ending);
  void subscribers(const std::atomic<bool>& ending);

  MasterClient client_;
};

}  // namespace laparoscope_servo::screen
