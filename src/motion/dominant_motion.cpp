#include "laparoscope_servo/motion/dominant_motion.h"

#include "laparoscope_servo/validation/error_report.h"
#include "motion/motion_sequence.h"

namespace laparoscope_servo::motion {

DominantMotion::DominantMotion(const MotionConfig& config) {
  validation::throwErrors("motion", validate(config));
  sequence_ = std::make_unique<MotionSequence>(config);
}

DominantMotion::DominantMotion(DominantMotion&&) noexcept = default;
DominantMotion& DominantMotion::operator=(DominantMotion&&) noexcept = default;
DominantMotion::~DominantMotion() = default;

const MotionResult& DominantMotion::begin(const cv::Mat& image, double stamp,
                                          const std::optional<geometry::Rectangle>& region, const cv::Mat& mask) {
  return sequence_->begin(image, stamp, region, mask);
}

const MotionResult& DominantMotion::track(const cv::Mat& image, double stamp,
                                          const std::optional<Eigen::Matrix3d>& motion, const cv::Mat& mask) {
  return sequence_->track(image, stamp, motion, mask);
}

void DominantMotion::reset() {
  sequence_->reset(features::Reason::kReset);
}

const MotionResult& DominantMotion::result() const {
  return sequence_->result();
}

const cv::Mat1b& DominantMotion::support() const {
  return sequence_->support().map();
}

cv::Size DominantMotion::cellSize() const {
  return sequence_->support().cellSize();
}

cv::Point DominantMotion::supportOrigin() const {
  return sequence_->supportOrigin();
}

}  // namespace laparoscope_servo::motion
