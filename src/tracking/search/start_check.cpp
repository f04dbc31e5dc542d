#include "tracking/search/start_check.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "laparoscope_servo/geometry/sl3.h"
#include "laparoscope_servo/image/warp.h"
#include "tracking/search/coarse_image.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr double kSide = 64.0;         // px, larger side of the ROI when compared
constexpr double kSurroundings = 4.0;  // px of the compared patch: blur of the local mean and deviation
constexpr float kLeast = 1.5f;         // grey levels: smaller local deviations are noise
// deviations, at which local contrast is clipped so that highlights do not dominate
constexpr float kMost = 3.0f;

// Means over the valid pixels around each pixel.
cv::Mat1f around(const cv::Mat1f& value, const cv::Mat1f& valid, const cv::Mat1f& share, double sigma) {
  cv::Mat1f mean;
  cv::GaussianBlur(value.mul(valid), mean, cv::Size(), sigma);
  return mean / share;
}

// Local contrast: deviation from the local mean over the local standard deviation; 0 where not valid.
cv::Mat1f localContrast(const cv::Mat1f& grey, const cv::Mat1f& valid) {
  cv::Mat1f share, smooth;
  cv::GaussianBlur(valid, share, cv::Size(), kSurroundings);
  share += 1e-3f;
  cv::GaussianBlur(grey, smooth, cv::Size(), 0.8);
  const cv::Mat1f detail = (smooth - around(grey, valid, share, kSurroundings)).mul(valid);
  cv::Mat1f deviation;
  cv::sqrt(around(detail.mul(detail), valid, share, kSurroundings), deviation);
  cv::Mat1f contrast = detail / cv::max(deviation, kLeast);
  cv::max(contrast, -kMost, contrast);
  cv::min(contrast, kMost, contrast);
  return contrast;
}

Eigen::Matrix3d shift(double x, double y) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m.topRightCorner<2, 1>() << x, y;
  return m;
}

}  // namespace

void StartCheck::setReference(const cv::Mat& image, const geometry::Rectangle& roi,
                              const image::ChannelWeights& weights) {
  roi_ = roi;
  weights_ = weights;
  step_ = std::max(1.0, std::max(roi.width, roi.height) / kSide);
  size_ = cv::Size(std::max(1, static_cast<int>(roi.width / step_)), std::max(1, static_cast<int>(roi.height / step_)));
  margin_ = static_cast<int>(kReach * std::max(size_.width, size_.height));
  reference_ = contrast(image, Eigen::Matrix3d::Identity(), 0);
}

// The ROI and `margin` [px of the compared patch] around it.
geometry::Rectangle StartCheck::widened(int margin) const {
  const double grow = margin * step_;
  return {roi_.x - grow, roi_.y - grow, roi_.width + 2.0 * grow, roi_.height + 2.0 * grow};
}

// The part of the image where `g` puts widened(margin); empty if there is none.
cv::Rect StartCheck::boxOf(const cv::Size& image, const Eigen::Matrix3d& g, int margin) const {
  const geometry::Quadrilateral corners = geometry::apply(g, widened(margin).corners());
  if (!geometry::isConvex(corners)) return {};
  return image::seenBox(lens_.get(), corners, 2.0) & cv::Rect(cv::Point(0, 0), image);
}

double StartCheck::pixelsTaken(const cv::Size& image, const Eigen::Matrix3d& g) const {
  return boxOf(image, g, margin_).area();
}

// Local contrast of the image where `g` puts the ROI and `margin` [px of the compared patch] around it; empty if no
// part of that is in the image.
cv::Mat1f StartCheck::contrast(const cv::Mat& image, const Eigen::Matrix3d& g, int margin) const {
  const cv::Rect box = boxOf(image.size(), g, margin);
  if (box.empty()) return {};
  const geometry::Rectangle wide = widened(margin);
  const geometry::Quadrilateral corners = geometry::apply(g, wide.corners());
  const double zoom = std::sqrt(geometry::signedArea(corners) / geometry::signedArea(wide.corners()));
  const int scale = std::max(1, std::min({static_cast<int>(step_ * zoom), box.width, box.height}));
  cv::Mat small;
  const cv::Size size(box.width / scale, box.height / scale);
  cv::resize(image(cv::Rect(box.tl(), size * scale)), small, size, 0.0, 0.0, cv::INTER_AREA);
  cv::Mat1f grey;
  oneChannel(small, weights_).convertTo(grey, CV_32F);

  Eigen::Matrix3d image_T_patch = g * shift(wide.x + 0.5 * (step_ - 1.0), wide.y + 0.5 * (step_ - 1.0));
  image_T_patch.leftCols<2>() *= step_;
  cv::Mat1f patch(size_.height + 2 * margin, size_.width + 2 * margin);
  cv::Mat1f valid(patch.size());
  const double middle = 0.5 * (scale - 1.0);  // px of the image: offset of the first pixel's centre
  if (lens_) {
    // The origin is rounded to whole pixels; half a pixel does not matter here.
    const cv::Point origin = box.tl() + cv::Point(cvFloor(middle), cvFloor(middle));
    image::warpBilinear(grey, image_T_patch, *lens_, {origin, static_cast<double>(scale)}, patch, valid);
  } else {
    Eigen::Matrix3d small_T_image = shift(-(box.x + middle) / scale, -(box.y + middle) / scale);
    small_T_image(0, 0) = small_T_image(1, 1) = 1.0 / scale;
    image::warpBilinear(grey, small_T_image * image_T_patch, patch, valid);
  }
  return localContrast(patch, valid);
}

CheckedStart StartCheck::look(const cv::Mat& image, const Eigen::Matrix3d& g) const {
  const cv::Mat1f seen = contrast(image, g, margin_);
  if (seen.empty()) return {g, 0.0};
  cv::Mat1f score;
  cv::matchTemplate(seen, reference_, score, cv::TM_CCORR_NORMED);
  double best = 0.0;
  cv::Point place;
  cv::minMaxLoc(score, nullptr, &best, nullptr, &place);
  if (!std::isfinite(best)) return {g, 0.0};
  const Eigen::Matrix3d moved = g * shift(step_ * (place.x - margin_), step_ * (place.y - margin_));
  return {geometry::normaliseDeterminant(moved), std::clamp(best, -1.0, 1.0)};
}

}  // namespace laparoscope_servo::tracking
