#include "servo/task/tip_stillness.h"

namespace laparoscope_servo::servo {

void TipStillness::see(double time, const Eigen::Vector2d& tip) {
  const bool is_near = (tip - place_).norm() <= still_;  // false for NaN
  if (!is_seen_ || !is_near || !(time >= last_)) {
    since_ = time;
    place_ = tip;
  }
  is_seen_ = tip.allFinite();
  last_ = time;
}

}  // namespace laparoscope_servo::servo
