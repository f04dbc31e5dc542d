// How old stamped data is, on two clocks at once.
//
// The steady clock says how long ago something new came: it notices a sender that stopped, or that repeats itself,
// whatever ROS time does (paused, looped, simulated). ROS time says how old the data was when it was sent: it notices
// data that waited in a queue. The age is the larger of the two.
#pragma once

#include <ros/time.h>

#include <string>

namespace laparoscope_servo {

class StampWatch {
 public:
  enum class Arrival { kNew, kRepeated, kBack };

  // Data with this stamp arrived. Repeated data counts as none; data older than the last one is taken as the new start.
  Arrival arrived(const ros::Time& stamp, double steady_now);

  bool empty() const { return empty_; }
  void clear() { empty_ = true; }

  // s, never negative. Only when not empty.
  double age(const ros::Time& now, double steady_now) const;
  // Its two parts: since something new came, and since the stamp.
  double silence(double steady_now) const;
  double stampAge(const ros::Time& now) const;

  // The stamp lies more than `tolerance` s ahead of ROS time: the clocks of two machines differ.
  bool isAhead(const ros::Time& now, double tolerance) const;

 private:
  bool empty_ = true;
  ros::Time stamp_;
  double steady_arrival_ = 0.0;
};

}  // namespace laparoscope_servo
