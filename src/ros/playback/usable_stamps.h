// Makes the stamps of a bag unique: a stamp of zero, or one equal to the last image's, is replaced by the time of
// recording minus this bag's usual delay between stamp and recording.
#pragma once

#include <ros/time.h>

#include <cstddef>

namespace laparoscope_servo {

class UsableStamps {
 public:
  // Takes the delay of an image that has a stamp.
  void learn(const ros::Time& stamp, const ros::Time& recorded) { latency_ = recorded - stamp; }
  // The stamp to use; call for each image in turn.
  ros::Time of(const ros::Time& stamp, const ros::Time& recorded);
  std::size_t replaced() const { return replaced_; }

 private:
  ros::Duration latency_;
  bool any_ = false;
  ros::Time given_;  // original stamp of the last image
  ros::Time last_;   // stamp used for it
  std::size_t replaced_ = 0;
};

}  // namespace laparoscope_servo
