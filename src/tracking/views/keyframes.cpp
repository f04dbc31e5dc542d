#include "tracking/views/keyframes.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

namespace laparoscope_servo::tracking {

namespace {

constexpr double kLengthStep = 1.3;  // factor of scale between two views that a binary descriptor tolerates, about
constexpr double kTurnStep = 0.6;    // rad
// Margin of tissue kept around the ROI: detectors find no points near the border of an image, and small or smooth
// regions are found by their surroundings.
constexpr double kMargin = 0.08;      // of the image's diagonal
constexpr double kMarginOfRoi = 0.5;  // of the ROI's diagonal, if that is more

}  // namespace

double keyframeDistance(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b, const geometry::Rectangle& roi) {
  const Eigen::Vector2d middle(roi.x + 0.5 * roi.width, roi.y + 0.5 * roi.height);
  const Eigen::Matrix2d from = geometry::derivative(b, middle);
  const Eigen::Matrix2d to = geometry::derivative(a, middle);
  if (!(from.determinant() > 0.0) || !(to.determinant() > 0.0)) return std::numeric_limits<double>::infinity();
  const Eigen::Matrix2d change = to * from.inverse();
  const Eigen::Vector2d lengths = Eigen::JacobiSVD<Eigen::Matrix2d>(change).singularValues();
  const double turn = std::atan2(change(1, 0) - change(0, 1), change(0, 0) + change(1, 1));
  return std::max({std::abs(std::log(lengths[0])) / std::log(kLengthStep),
                   std::abs(std::log(lengths[1])) / std::log(kLengthStep), std::abs(turn) / kTurnStep});
}

void Keyframes::setReference(const cv::Mat& image, const geometry::Rectangle& roi, const cv::Mat1f& weights) {
  roi_ = roi;
  keyframes_.clear();
  recent_ = Keyframe();
  recent_pixels_.release();
  keyframes_.push_back(cut(image, Eigen::Matrix3d::Identity(), weights));
}

double Keyframes::nearest(const Eigen::Matrix3d& g, int except) const {
  double distance = std::numeric_limits<double>::infinity();
  for (int k = 0; k < stored(); ++k) {
    if (k != except) distance = std::min(distance, keyframeDistance(g, keyframes_[k].g, roi_));
  }
  return distance;
}

int Keyframes::leastSingular() const {
  int least = 1;
  for (int k = 2; k < stored(); ++k) {
    if (nearest(keyframes_[k].g, k) < nearest(keyframes_[least].g, least)) least = k;
  }
  return least;
}

bool Keyframes::wants(const Eigen::Matrix3d& g) const {
  if (capacity_ == 0 || keyframes_.empty()) return false;
  const double distance = nearest(g, -1);
  if (!(distance >= 1.0) || !std::isfinite(distance)) return false;
  if (stored() <= capacity_) return true;
  const int least = leastSingular();
  return distance > nearest(keyframes_[least].g, least);
}

void Keyframes::add(const cv::Mat& image, const Eigen::Matrix3d& g, const cv::Mat1f& weights) {
  Keyframe keyframe = cut(image, g, weights);
  if (keyframe.crop.empty()) return;
  if (stored() <= capacity_) {
    keyframes_.push_back(std::move(keyframe));
  } else {
    keyframes_[leastSingular()] = std::move(keyframe);
  }
}

void Keyframes::addRecent(const cv::Mat& image, const Eigen::Matrix3d& g, const cv::Mat1f& weights) {
  const cv::Rect box = boxOf(image, g);
  if (capacity_ == 0 || box.empty()) return;
  recent_pixels_.create(image.size(), image.type());
  recent_.crop = recent_pixels_(cv::Rect(cv::Point(0, 0), box.size()));
  image(box).copyTo(recent_.crop);
  recent_.first = box.tl();
  recent_.g = g;
  cv::compare(weights, 0.0, recent_.trusted, cv::CMP_GT);
  recent_.described = false;
  recent_.strips_described = 0;
  recent_.features.points.clear();
  recent_.features.descriptors.release();
}

// The box of the image that holds the ROI and its margin.
cv::Rect Keyframes::boxOf(const cv::Mat& image, const Eigen::Matrix3d& g) const {
  const geometry::Quadrilateral corners = geometry::apply(g, roi_.corners());
  const double diagonal = std::max((corners[2] - corners[0]).norm(), (corners[3] - corners[1]).norm());
  const double margin = std::max(kMargin * std::hypot(image.cols, image.rows), kMarginOfRoi * diagonal);
  return image::seenBox(lens_.get(), corners, margin) & cv::Rect(cv::Point(0, 0), image.size());
}

Keyframe Keyframes::cut(const cv::Mat& image, const Eigen::Matrix3d& g, const cv::Mat1f& weights) const {
  const cv::Rect box = boxOf(image, g);
  Keyframe keyframe;
  keyframe.g = g;
  if (box.empty()) return keyframe;
  keyframe.crop = image(box).clone();
  keyframe.first = box.tl();
  keyframe.trusted = weights > 0.0f;
  return keyframe;
}

}  // namespace laparoscope_servo::tracking
