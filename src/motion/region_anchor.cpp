#include "motion/region_anchor.h"

#include <cmath>

namespace laparoscope_servo::motion {

namespace {

// Px, and standard deviations of what the steps have led to: a comparison that is further off found something else. As
// AnchoredMotion has them.
constexpr double kSurprise = 2.0, kDeviations = 4.0;
constexpr double kGrown = 1.5;  // factor on the region's area, by which a comparison may differ from what is expected

Eigen::Matrix3d shiftBy(const cv::Point& by) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m.topRightCorner<2, 1>() << by.x, by.y;
  return m;
}

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
  return {box_.x + 0.5 * (box_.width - 1), box_.y + 0.5 * (box_.height - 1)};
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
  return !known_ || geometry::largestDistance(there, expected) <= kSurprise + kDeviations * std::sqrt(variance_);
}

bool RegionAnchor::compare(const MotionImage& current, const cv::Rect& box) {
  const Eigen::Matrix3d box_from_image = shiftBy(-box.tl()), image_from_box = shiftBy(box.tl());
  const Eigen::Matrix3d image_from_anchor = shiftBy(box_.tl()), anchor_from_image = shiftBy(-box_.tl());
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
