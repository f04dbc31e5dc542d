// A node of its own that publishes images of one pixel, 25 a second: within one process nobody could tell two
// publishers apart.
#pragma once

#include <string>

#include "system/aesop/child_process.h"

namespace laparoscope_servo::test_support {

class SecondPublisher {
 public:
  explicit SecondPublisher(const std::string& topic)
      : process_("/usr/bin/env",
                 {"rostopic", "pub", "-r", "25", topic, "sensor_msgs/Image",
                  "{header: {stamp: {secs: 990}}, height: 1, width: 1, encoding: mono8, step: 1, data: [7]}"}) {}
  ~SecondPublisher() {
    process_.kill(SIGINT);  // it takes its leave of the master
    process_.exitStatus(20.0);
  }

 private:
  test::ChildProcess process_;
};

}  // namespace laparoscope_servo::test_support
