// Age of stamped data, by two clocks.
//
// The steady clock measures the time since new data came: it detects a sender that stopped or repeats itself, also if
// ROS time is paused, looped or simulated. ROS time measures the age since the stamp: it detects data that waited in a
// queue. The age is the larger of both.
#pragma once

#include <ros/time.h>

#include <string>

namespace laparoscope_servo {

class StampWatch {
 public:
  enum class Arrival { kNew, kRepeated, kBack };

  // Call when data with this stamp arrived. Repeated data is ignored; data older than the last one is a new start.
  Arrival arrived(const ros::Time& stamp, double steady_now);

  bool empty() const { return empty_; }
  void clear() { empty_ = true; }

  // All below: call only if not empty. Of the last data.
  const ros::Time& stamp() const { return stamp_; }
  // s, never negative.
  double age(const ros::Time& now, double steady_now) const;
  // The two parts of the age: since new data came, and since the stamp.
  double silence(double steady_now) const;
  double stampAge(const ros::Time& now) const;

  // Whether the stamp is more than `tolerance` s ahead of ROS time, because clocks of two machines differ.
  bool isAhead(const ros::Time& now, double tolerance) const;

 private:
  bool empty_ = true;
  ros::Time stamp_;
  double steady_arrival_ = 0.0;
};

}  // namespace laparoscope_servo
