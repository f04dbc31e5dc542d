#include "tracking/region_history.h"

#include <algorithm>

namespace laparoscope_servo::tracking {

void RegionHistory::start(const geometry::Rectangle& roi, const Eigen::Matrix3d& normalisation, double stamp) {
  filter_.start(roi, normalisation, stamp);
  record_ = TrackRecord();
  last_ = EsmState();
  proven_stamp_ = stamp;
  proven_visible_ = 1.0;
  unseen_before_ = 0.0;
}

void RegionHistory::startUnseen(const geometry::Rectangle& roi, const Eigen::Matrix3d& normalisation,
                                double reference_stamp, double now) {
  start(roi, normalisation, now);
  unseen_before_ = std::max(0.0, now - reference_stamp);
}

void RegionHistory::compare(double stamp, Evidence& evidence) const {
  evidence.last_gain = last_.gain;
  evidence.unseen = unseen_before_ + stamp - filter_.lastStamp();
  evidence.unproven = stamp - proven_stamp_;
  evidence.proven_visible = proven_visible_;
  evidence.record = record_;
}

void RegionHistory::addTracked(const Evidence& found, const MotionPrior& prior, double stamp,
                               const std::optional<Eigen::Matrix3d>& carried) {
  const double innovation = geometry::cornerDistance(found.predicted, found.esm.state.g, found.roi);
  record_.add(found.zncc, found.esm.sigma, innovation, found.visible_fraction, sinceLast(stamp));
  filter_.update(prior, found.esm, stamp, found.visible_fraction >= kRecordVisible, carried);
  take(found, stamp);
}

void RegionHistory::addFoundAgain(const Evidence& found, double stamp) {
  filter_.restart(found.esm, stamp);
  take(found, stamp);
}

void RegionHistory::take(const Evidence& found, double stamp) {
  if (found.blocks.confident >= leastBlocks(found.blocks, found.visible_fraction)) {
    proven_stamp_ = stamp;
    proven_visible_ = found.visible_fraction;
  }
  unseen_before_ = 0.0;
  last_ = found.esm.state;
}

}  // namespace laparoscope_servo::tracking
