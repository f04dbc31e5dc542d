// Frees a tf buffer of transforms from the future.
//
// When ROS time jumps back (a bag in a loop, a simulation that starts again), transforms that were sent before arrive
// after it. A buffer that has taken one of them drops all that is older than its history, and answers with it where the
// newest is asked for: until time has come that far, for hours perhaps, it tells nothing true.
#pragma once

#include <tf2/buffer_core.h>

#include <limits>
#include <string>

namespace laparoscope_servo::skin {

class FutureTransforms {
 public:
  // `tolerance`: s, by how much clocks of machines may differ.
  explicit FutureTransforms(double tolerance) : tolerance_(tolerance) {}

  // Whether the newest transform from `source` to `target` lies further ahead of `now`. The buffer is then emptied of
  // all that is not static, at most once a second, as a clock that is simply wrong brings the next one; until a true
  // one has come, or that second is over, the answer stays. `steady_now`: s.
  bool found(tf2::BufferCore& tf, const std::string& target, const std::string& source, const ros::Time& now,
             double steady_now);

 private:
  double tolerance_;
  double emptied_ = -std::numeric_limits<double>::infinity();  // s, steady
};

}  // namespace laparoscope_servo::skin
