#include "laparoscope_servo/tracking/region_tracker.h"

#include "laparoscope_servo/validation/error_report.h"
#include "tracking/region_tracker_implementation.h"
#include "tracking/roi_check.h"
#include "tracking/selection/proposal.h"

namespace laparoscope_servo::tracking {

RegionTracker::RegionTracker(const TrackerConfig& config) {
  validation::throwErrors("tracker", validate(config));
  implementation_ = std::make_unique<Implementation>(config);
}

RegionTracker::~RegionTracker() = default;
RegionTracker::RegionTracker(RegionTracker&&) noexcept = default;
RegionTracker& RegionTracker::operator=(RegionTracker&&) noexcept = default;

void RegionTracker::retune(const TrackerConfig& config) {
  validation::throwErrors("tracker", validate(config));
  implementation_->retune(config);
}
void RegionTracker::setLens(const std::optional<image::Lens>& lens) {
  implementation_->setLens(lens);
}

TrackResult RegionTracker::select(const cv::Mat& image, double stamp, const geometry::Rectangle& roi,
                                  const cv::Mat& external_mask) {
  return implementation_->select(image, stamp, roi, external_mask);
}
void RegionTracker::check(const cv::Mat& image, const geometry::Rectangle& roi) const {
  RegionAligner aligner(config(), implementation_->lens());
  takeReference(image, roi, cv::Mat(), config(), implementation_->lens().get(), aligner);
}
std::optional<geometry::Rectangle> RegionTracker::propose(const cv::Mat& image, const geometry::Rectangle& roi) const {
  return proposeRegion(image, roi, config(), implementation_->lens());
}
void RegionTracker::recall(const cv::Mat& reference, double reference_stamp, const geometry::Rectangle& roi,
                           double now) {
  implementation_->recall(reference, reference_stamp, roi, now);
}
const TrackResult& RegionTracker::track(const cv::Mat& image, double stamp,
                                        const std::optional<Eigen::Matrix3d>& motion, const cv::Mat& external_mask) {
  return implementation_->track(image, stamp, motion, external_mask);
}
void RegionTracker::reset() {
  implementation_->reset();
}
cv::Mat RegionTracker::occlusionMask() const {
  return implementation_->occlusionMask();
}
bool RegionTracker::hasRoi() const {
  return implementation_->hasRoi();
}
const TrackerConfig& RegionTracker::config() const {
  return implementation_->config();
}

}  // namespace laparoscope_servo::tracking
