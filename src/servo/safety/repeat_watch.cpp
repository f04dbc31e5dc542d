#include "servo/safety/repeat_watch.h"

namespace laparoscope_servo::servo {

namespace {

bool same(const TaskError& a, const TaskError& b) {
  return a.e_v == b.e_v && a.e_w == b.e_w && a.x == b.x && a.y == b.y && a.log_depth == b.log_depth &&
         a.alpha == b.alpha;
}

}  // namespace

void RepeatWatch::take(double image_time, const TaskError& error, bool moves) {
  if (last_ && image_time == image_time_) return;
  const bool repeated = last_ && same(*last_, error);
  image_time_ = image_time;
  last_ = error;
  if (!repeated) {
    count_ = 0;
    repeats_ = false;
  } else if (moves && ++count_ >= most_) {
    repeats_ = true;
  }
}

}  // namespace laparoscope_servo::servo
