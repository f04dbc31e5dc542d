#include "motion/region_anchor.h"

#include <Eigen/LU>
#include <cmath>

#include "motion/region_window.h"

namespace laparoscope_servo::motion {

namespace {

constexpr double kGrown = 1.5;  // factor on the region's area, by which a comparison may differ from what is expected

}  // namespace

RegionAnchor::RegionAnchor(const MotionConfig& config) : config_(config), estimator_(config, true) {
  starts_.reserve(MotionAligner::kMostStarts);
}

void RegionAnchor::begin(const cv::Mat& image, const cv::Mat& mask, const cv::Rect& box,
                         const geometry::Quadrilateral& region) {
  box_ = box;
  region_ = region;
  anchor_.take(image(box), mask.empty() ? mask : mask(box), config_);
  estimator_.setReference(anchor_);
  estimator_.forget();
  g_.setIdentity();
  compared_.setIdentity();
  known_ = true;
  variance_ = 0.0;
}

Eigen::Vector2d RegionAnchor::middle() const {
  return middleOf(box_);
}

void RegionAnchor::goOn(const Eigen::Matrix3d& step, double error) {
  g_ = step * g_;
  g_ /= std::cbrt(g_.determinant());
  known_ = known_ && std::isfinite(error);
  if (known_) variance_ += error * error;
}

bool RegionAnchor::isPlausible(const Eigen::Matrix3d& g) const {
  const geometry::Quadrilateral there = geometry::apply(g, region_), expected = region();
  if (!geometry::isConvex(there)) return false;
  const double grown = geometry::signedArea(there) / geometry::signedArea(expected);
  if (!(grown > 1.0 / kGrown && grown < kGrown)) return false;
  return !known_ || geometry::largestDistance(there, expected) <= mostSurprise(std::sqrt(variance_));
}

bool RegionAnchor::compare(const MotionImage& current, const cv::Rect& box) {
  const Eigen::Matrix3d image_from_box = imageFromBox(box), box_from_image = image_from_box.inverse();
  const Eigen::Matrix3d image_from_anchor = imageFromBox(box_), anchor_from_image = image_from_anchor.inverse();
  starts_.assign(1, box_from_image * g_ * image_from_anchor);
  if (!known_) starts_.push_back(box_from_image * compared_ * image_from_anchor);
  found_ = estimator_.estimate(anchor_, current, starts_, geometry::apply(anchor_from_image, region_), false);
  if (found_.why != features::Reason::kNone) return false;
  const Eigen::Matrix3d g = image_from_box * found_.at.g * anchor_from_image;
  if (!isPlausible(g)) {
    known_ = false;  // anchor and steps contradict each other
    return false;
  }
  g_ = compared_ = g;
  known_ = true;
  variance_ = 0.0;
  return true;
}

}  // namespace laparoscope_servo::motion
