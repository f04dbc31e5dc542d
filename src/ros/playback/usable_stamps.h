// Stamps that can stand for an image: not zero, and not that of the image before. One that cannot is replaced by the
// time of recording, less what recordings are later than stamps in this bag.
#pragma once

#include <ros/time.h>

#include <cstddef>

namespace laparoscope_servo {

class UsableStamps {
 public:
  // Of an image that has a stamp.
  void learn(const ros::Time& stamp, const ros::Time& recorded) { latency_ = recorded - stamp; }
  // Of each image in turn.
  ros::Time of(const ros::Time& stamp, const ros::Time& recorded);
  std::size_t replaced() const { return replaced_; }

 private:
  ros::Duration latency_;
  bool any_ = false;
  ros::Time given_;  // of the image before
  ros::Time last_;   // what was made of it
  std::size_t replaced_ = 0;
};

}  // namespace laparoscope_servo
