// When the arm was as a status tells it.
#pragma once

#include <ros/time.h>

#include <optional>

namespace laparoscope_servo {

// Gives each status its stamp. The controller says how the arm is when a request has come, and its answer, several
// times as long as the request, is under way for longer: of what is known, the time at which the request was sent is
// nearest to that, and what relies on the pose never takes it for younger than it is.
class StatusStamp {
 public:
  // `age`: s, since the request that the status answers was sent. Nothing for one that answers no later request than
  // the one before: who listens refuses a stamp that comes twice.
  std::optional<ros::Time> take(double age, double steady_now, const ros::Time& now) {
    const double at = steady_now - age;
    if (!(age >= 0.0) || !(at > last_ + kSame)) return std::nullopt;
    last_ = at;
    // Simulated time may have begun after that.
    return now.toSec() > age ? now - ros::Duration(age) : ros::Time();
  }

 private:
  static constexpr double kSame = 1e-6;  // s, rounding

  double last_ = -1.0;  // s, steady: of the status before
};

}  // namespace laparoscope_servo
