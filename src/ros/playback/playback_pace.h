// When the images of a recording are due: its own time against a steady clock, at a speed.
#pragma once

#include <ros/time.h>

#include <chrono>

namespace laparoscope_servo {

class PlaybackPace {
 public:
  using Clock = std::chrono::steady_clock;

  // `speed` > 0: 2 plays twice as fast as it was recorded.
  explicit PlaybackPace(double speed) : speed_(speed) {}

  // From here on: what has the time `time` in the recording is due at `due`.
  void begin(const ros::Time& time, Clock::time_point due);
  // Everything is due by so much later.
  void delay(Clock::duration by) { begin_due_ += by; }

  Clock::time_point due(const ros::Time& time) const;
  // The recording's time at a moment: the inverse of due().
  ros::Time at(Clock::time_point moment) const;

 private:
  double speed_;
  ros::Time begin_;
  Clock::time_point begin_due_;
};

}  // namespace laparoscope_servo
