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

  // Asks the master who it is, for half a second at most; another one than the last time is told. True when it was.
  // The first call, before anything is published, only notes who it is. `ending`: gives up.
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
