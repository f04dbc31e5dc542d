// Decides from repeated pictures whether the images still show what is there.
//
// A picture that repeats as a whole is not believed. In a compressed feed the region alone may repeat, because the
// codec skips blocks that hardly change: that is believed for a short time, while nothing says that the region should
// have moved. A part of the region may repeat for as long as the region has moved by less than a codec skips.
#pragma once

#include <string>

#include "laparoscope_servo/image/repeat_watch.h"
#include "laparoscope_servo/tracking/input_config.h"

namespace laparoscope_servo::tracking {

class FrozenFeed {
 public:
  explicit FrozenFeed(const InputConfig& config) : config_(config) {}

  // How far the region's corner that moved most has moved [px]; 0 where the region was not tracked.
  struct Motion {
    double step = 0.0;      // by the image, since the picture before
    double of_part = 0.0;   // by the image, at most during the pictures in which the part repeated that repeats now
    double by_robot = 0.0;  // by what a robot says, since the last picture that was believed and not one that repeats
  };

  // Of one picture: how it repeats, its stamp [s], how the region moved.
  void see(const image::Repeats& repeats, double stamp, const Motion& motion);

  // Why the picture shows nothing that may be believed; empty when it may be. Once said, it is said until more than
  // `max_repeats` pictures in a row were new.
  const std::string& reason() const { return reason_; }

 private:
  void watchMotion(const image::Repeats& repeats, const Motion& motion);
  void judge(const image::Repeats& repeats);

  InputConfig config_;
  double last_new_stamp_ = 0.0;
  double last_new_part_stamp_ = 0.0;
  double stamp_ = 0.0;
  double speed_ = 0.0;  // px an image, over the last new ones
  bool moving_ = false;
  int part_limit_ = 0;  // pictures in which a part may repeat, by how far the region moved meanwhile
  enum class Frozen { kNot, kWhole, kRegion, kPart } frozen_ = Frozen::kNot;
  int fresh_ = 0;  // new pictures in a row since
  std::string reason_;
};

}  // namespace laparoscope_servo::tracking
