#include "ros/common/stamp_watch.h"

#include <algorithm>

namespace laparoscope_servo {

StampWatch::Arrival StampWatch::arrived(const ros::Time& stamp, double steady_now) {
  if (!empty_ && stamp == stamp_) return Arrival::kRepeated;
  const bool back = !empty_ && stamp < stamp_;
  empty_ = false;
  stamp_ = stamp;
  steady_arrival_ = steady_now;
  return back ? Arrival::kBack : Arrival::kNew;
}

double StampWatch::age(const ros::Time& now, double steady_now) const {
  return std::max(silence(steady_now), stampAge(now));
}

double StampWatch::silence(double steady_now) const {
  return std::max(0.0, steady_now - steady_arrival_);
}

double StampWatch::stampAge(const ros::Time& now) const {
  return std::max(0.0, now.toSec() - stamp_.toSec());
}

bool StampWatch::isAhead(const ros::Time& now, double tolerance) const {
  return stamp_.toSec() - now.toSec() > tolerance;
}

}  // namespace laparoscope_servo
