#include "laparoscope_servo/tracking/frozen_feed.h"

#include <sstream>

namespace laparoscope_servo::tracking {

void FrozenFeed::see(const image::Repeats& repeats, double stamp, double step, double robot_step) {
  if (repeats.region == 0) {
    // The mean of the last two or so: one estimate that jumps is no motion, and a motion is over as quickly.
    speed_ = 0.5 * (speed_ + step);
    moving_ = speed_ > config_.moving;
    last_new_stamp_ = stamp;
  } else if (robot_step > config_.moved) {
    moving_ = true;
  }
  stamp_ = stamp;
  judge(repeats);
}

void FrozenFeed::judge(const image::Repeats& repeats) {
  const int region_limit = moving_ ? config_.max_repeats : config_.max_still_repeats;
  const bool repeated = frozen_ == Frozen::kRegion ? repeats.region > 0 : repeats.whole > 0;
  fresh_ = repeated ? 0 : fresh_ + 1;
  if (repeats.whole > config_.max_repeats) {
    frozen_ = Frozen::kWhole;
  } else if (repeats.region > region_limit) {
    frozen_ = Frozen::kRegion;
  } else if (fresh_ > config_.max_repeats) {
    frozen_ = Frozen::kNot;
  }
  reason_.clear();
  if (frozen_ == Frozen::kNot) return;
  std::ostringstream text;
  text.precision(3);
  text << (frozen_ == Frozen::kWhole ? "the picture repeats" : "the picture repeats within the region");
  const int count = frozen_ == Frozen::kWhole ? repeats.whole : repeats.region;
  if (count > 0) {
    text << ": " << count << (count == 1 ? " image, " : " images, ") << stamp_ - last_new_stamp_ << " s";
  } else {
    text << " every few images";
  }
  reason_ = text.str();
}

}  // namespace laparoscope_servo::tracking
