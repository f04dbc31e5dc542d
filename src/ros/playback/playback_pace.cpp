#include "ros/playback/playback_pace.h"

namespace laparoscope_servo {

using std::chrono::duration;
using std::chrono::duration_cast;

void PlaybackPace::begin(const ros::Time& time, Clock::time_point due) {
  begin_ = time;
  begin_due_ = due;
}

PlaybackPace::Clock::time_point PlaybackPace::due(const ros::Time& time) const {
  return begin_due_ + duration_cast<Clock::duration>(duration<double>((time - begin_).toSec() / speed_));
}

ros::Time PlaybackPace::at(Clock::time_point moment) const {
  return begin_ + ros::Duration(duration<double>(moment - begin_due_).count() * speed_);
}

}  // namespace laparoscope_servo
