#include "ros/playback/usable_stamps.h"

namespace laparoscope_servo {

ros::Time UsableStamps::of(const ros::Time& stamp, const ros::Time& recorded) {
  ros::Time usable = stamp;
  if (stamp.isZero() || (any_ && stamp == given_)) {
    if (recorded.toSec() > latency_.toSec()) usable = recorded - latency_;
    if (any_ && !(usable > last_)) usable = last_ + ros::Duration(0, 1);
    if (usable != stamp) ++replaced_;
  } else {
    learn(stamp, recorded);
  }
  given_ = stamp;
  last_ = usable;
  any_ = true;
  return usable;
}

}  // namespace laparoscope_servo
