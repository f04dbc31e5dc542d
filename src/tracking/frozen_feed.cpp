#include "laparoscope_servo/tracking/frozen_feed.h"

#include <algorithm>
#include <sstream>

namespace laparoscope_servo::tracking {

void FrozenFeed::see(const image::Repeats& repeats, double stamp, const Motion& motion) {
  watchMotion(repeats, motion);
  if (repeats.region == 0 && repeats.part == 0) last_new_stamp_ = stamp;
  stamp_ = stamp;
  judge(repeats);
}

void FrozenFeed::watchMotion(const image::Repeats& repeats, const Motion& motion) {
  // The mean of the last two or so: one estimate that jumps is no motion, and a motion is over as quickly.
  const double speed = 0.5 * (speed_ + motion.step);
  // What repeats may be what the region was found by: then the estimate tells of motion, not of rest.
  if ((repeats.region == 0 && repeats.part == 0) || speed > speed_) {
    speed_ = speed;
    moving_ = speed_ > config_.moving;
  }
  if (repeats.region > 0 && motion.by_robot > config_.moved) moving_ = true;
  by_robot_ = repeats.part == 0 ? 0.0 : by_robot_ + (repeats.region == 0 ? motion.by_robot : 0.0);
  part_moved_ = repeats.part > 0 && std::max(motion.since_new, by_robot_) > config_.moved;
}

void FrozenFeed::judge(const image::Repeats& repeats) {
  const int region_limit = moving_ ? config_.max_repeats : config_.max_still_repeats;
  const bool repeated = frozen_ == Frozen::kPart     ? repeats.part > 0
                        : frozen_ == Frozen::kRegion ? repeats.region > 0
                                                     : repeats.whole > 0;
  fresh_ = repeated ? 0 : fresh_ + 1;
  if (repeats.whole > config_.max_repeats) {
    frozen_ = Frozen::kWhole;
  } else if (repeats.region > region_limit) {
    frozen_ = Frozen::kRegion;
  } else if (repeats.part > config_.max_repeats && part_moved_) {
    frozen_ = Frozen::kPart;
  } else if (fresh_ > config_.max_repeats) {
    frozen_ = Frozen::kNot;
  }
  reason_.clear();
  if (frozen_ == Frozen::kNot) return;
  std::ostringstream text;
  text.precision(3);
  text << (frozen_ == Frozen::kWhole    ? "the picture repeats"
           : frozen_ == Frozen::kRegion ? "the picture repeats within the region"
                                        : "the picture repeats within a part of the region");
  const int count = frozen_ == Frozen::kWhole    ? repeats.whole
                    : frozen_ == Frozen::kRegion ? repeats.region
                                                 : repeats.part;
  if (count > 0) {
    text << ": " << count << (count == 1 ? " image, " : " images, ") << stamp_ - last_new_stamp_ << " s";
  } else {
    text << " every few images";
  }
  reason_ = text.str();
}

}  // namespace laparoscope_servo::tracking
