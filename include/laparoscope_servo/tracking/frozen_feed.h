// Decides from repeated pictures whether the images still show what is there.
//
// A whole picture that repeats is none. The region alone may repeat in a compressed feed, whose codec skips what hardly
// changes: that is believed while nothing says that the region should have moved, and not for long.
#pragma once

#include <string>

#include "laparoscope_servo/image/repeat_watch.h"
#include "laparoscope_servo/tracking/input_config.h"

namespace laparoscope_servo::tracking {

class FrozenFeed {
 public:
  explicit FrozenFeed(const InputConfig& config) : config_(config) {}

  // Of one picture: how it repeats, its stamp [s], by how much the region moved since the picture before by the image,
  // and since it last looked new by what a robot says [px; 0 where nothing is known].
  void see(const image::Repeats& repeats, double stamp, double step, double robot_step);

  // Why the picture shows nothing that may be believed; empty when it may be. Once said, it is said until more than
  // `max_repeats` pictures in a row were new.
  const std::string& reason() const { return reason_; }

 private:
  void judge(const image::Repeats& repeats);

  InputConfig config_;
  double last_new_stamp_ = 0.0;
  double stamp_ = 0.0;
  double speed_ = 0.0;  // px an image, over the last new ones
  bool moving_ = false;
  enum class Frozen { kNot, kWhole, kRegion } frozen_ = Frozen::kNot;
  int fresh_ = 0;  // new pictures in a row since
  std::string reason_;
};

}  // namespace laparoscope_servo::tracking
