#include "laparoscope_servo/tracking/frozen_feed.h"

#include <limits>
#include <sstream>

namespace laparoscope_servo::tracking {

namespace {

// Extra repeats allowed for a part: a codec may skip a quarter of a region for two pictures while the estimate of a
// partly covered region swings by some px (instrument_crossing.mp4 of the films, 25 Hz).
constexpr int kSkipped = 1;

}  // namespace

void FrozenFeed::see(const image::Repeats& repeats, double stamp, const Motion& motion) {
  watchMotion(repeats, motion);
  if (repeats.region == 0) last_new_stamp_ = stamp;
  if (repeats.part == 0) last_new_part_stamp_ = stamp;
  stamp_ = stamp;
  judge(repeats);
}

void FrozenFeed::watchMotion(const image::Repeats& repeats, const Motion& motion) {
  // A mean with half the weight on the newest step: a single jump of the estimate is no motion, and a motion ends as
  // quickly. While the region repeats, the estimate may rest on the repeating pixels; it can then show motion, but a
  // lower speed proves nothing.
  const double speed = 0.5 * (speed_ + motion.step);
  if (repeats.region == 0 || speed > speed_) {
    speed_ = speed;
    moving_ = speed_ > config_.moving;
  }
  if (repeats.region > 0 && motion.by_robot > config_.moved) moving_ = true;
  // While the region as a whole does not repeat, by_robot covers one image only: scaled by the number of repeats of the
  // part.
  const double by_robot = repeats.region == 0 ? motion.by_robot * repeats.part : motion.by_robot;
  part_limit_ = by_robot > config_.moved         ? config_.max_repeats
                : motion.of_part > config_.moved ? config_.max_repeats + kSkipped
                                                 : std::numeric_limits<int>::max();
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
  } else if (repeats.part > part_limit_) {
    frozen_ = Frozen::kPart;
  } else if (fresh_ > config_.max_repeats) {
    frozen_ = Frozen::kNot;
  }
  reason_.clear();
  if (frozen_ == Frozen::kNot) return;
  std::ostringstream text;
  text.precision(3);
  text << "the picture repeats";
  int count = repeats.whole;
  double since = last_new_stamp_;
  if (frozen_ == Frozen::kRegion) {
    text << " within the region";
    count = repeats.region;
  } else if (frozen_ == Frozen::kPart) {
    text << " within a part of the region";
    count = repeats.part;
    since = last_new_part_stamp_;
  }
  if (count > 0) {
    text << ": " << count << (count == 1 ? " image, " : " images, ") << stamp_ - since << " s";
  } else {
    text << " every few images";
  }
  reason_ = text.str();
}

}  // namespace laparoscope_servo::tracking
