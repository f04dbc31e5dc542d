// The time of the arm's state in a status.
#pragma once

#include <ros/time.h>

#include <optional>

namespace laparoscope_servo {

// Gives each status its stamp: the time at which its request was sent. The controller reads the arm's state when the
// request arrives; the answer is several times as long and takes longer to arrive. So that time is the best known one,
// and the pose never looks newer than it is.
class StatusStamp {
 public:
  // `age`: s, since the request that the status answers was sent. Empty if it answers no later request than the last
  // status, since subscribers refuse a repeated stamp.
  std::optional<ros::Time> take(double age, double steady_now, const ros::Time& now) {
    const double at = steady_now - age;
    if (!(age >= 0.0) || !(at > last_ + kSame)) return std::nullopt;
    last_ = at;
    // Simulated time may have begun later.
    return now.toSec() > age ? now - ros::Duration(age) : ros::Time();
  }

 private:
  static constexpr double kSame = 1e-6;  // s, rounding

  double last_ = -1.0;  // s, steady: of the last status
};

}  // namespace laparoscope_servo
