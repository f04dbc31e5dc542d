#include "laparoscope_servo/ros/future_transforms.h"

#include <tf2/exceptions.h>

namespace laparoscope_servo::skin {

namespace {

constexpr double kPause = 1.0;  // s

}  // namespace

bool FutureTransforms::found(tf2::BufferCore& tf, const std::string& target, const std::string& source,
                             const ros::Time& now, double steady_now) {
  const bool recent = steady_now - emptied_ < kPause;
  double newest = 0.0;
  try {
    newest = tf.lookupTransform(target, source, ros::Time(0)).header.stamp.toSec();
  } catch (const tf2::TransformException&) {
    return recent;
  }
  if (!(newest - now.toSec() > tolerance_)) return false;
  if (recent) return true;
  tf.clear();
  emptied_ = steady_now;
  return true;
}

}  // namespace laparoscope_servo::skin
