// Decides from repeated pictures whether the feed is frozen.
//
// A picture that repeats as a whole means a frozen feed. In a compressed feed the region alone may repeat, because the
// codec skips blocks that hardly change: this is accepted for a short time, as long as neither images nor robot show
// that the region moves. A part of the region may repeat for as long as the region has moved by less than a codec
// skips.
#pragma once

#include <string>

#include "laparoscope_servo/image/repeat_watch.h"
#include "laparoscope_servo/tracking/input_config.h"

namespace laparoscope_servo::tracking {

class FrozenFeed {
 public:
  explicit FrozenFeed(const InputConfig& config) : config_(config) {}

  // Displacement [px] of the region's corner that moved most; 0 if the region was not tracked.
  struct Motion {
    double step = 0.0;      // by the tracker, since the last picture
    double of_part = 0.0;   // by the tracker, largest over the pictures since the repeating part was last new
    double by_robot = 0.0;  // by the robot's motion, since the last picture that was accepted and new
  };

  // Takes one picture: how it repeats, its stamp [s], how the region moved.
  void see(const image::Repeats& repeats, double stamp, const Motion& motion);

  // Why the feed counts as frozen; empty if it does not. Holds until more than `max_repeats` pictures in a row were
  // new.
  const std::string& reason() const { return reason_; }

 private:
  void watchMotion(const image::Repeats& repeats, const Motion& motion);
  void judge(const image::Repeats& repeats);

  InputConfig config_;
  double last_new_stamp_ = 0.0;
  double last_new_part_stamp_ = 0.0;
  double stamp_ = 0.0;
  double speed_ = 0.0;  // px per image, over the last new ones
  bool moving_ = false;
  int part_limit_ = 0;  // number of pictures in which a part may repeat; depends on how far the region moved meanwhile
  enum class Frozen { kNot, kWhole, kRegion, kPart } frozen_ = Frozen::kNot;
  int fresh_ = 0;  // new pictures in a row
  std::string reason_;
};

}  // namespace laparoscope_servo::tracking
