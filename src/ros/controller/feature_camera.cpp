#include "ros/controller/feature_camera.h"

#include <algorithm>
#include <stdexcept>

namespace laparoscope_servo {

namespace {

cv::Size sizeOf(const sensor_msgs::CameraInfo& info) {
  const auto along = [](std::uint32_t sensor, std::uint32_t region, std::uint32_t binning) {
    return static_cast<int>((region > 0 ? region : sensor) / std::max(1u, binning));
  };
  return {along(info.width, info.roi.width, info.binning_x), along(info.height, info.roi.height, info.binning_y)};
}

}  // namespace

bool FeatureCamera::take(const sensor_msgs::CameraInfo& info) {
  if (info_ && sameCalibration(*info_, info)) return false;
  const bool another = info_.has_value();
  info_ = info;
  lens_.reset();
  size_ = sizeOf(info);
  problem_.clear();
  try {
    if (size_.empty()) throw std::invalid_argument("camera_info cannot be used: it has no size of the image");
    if (rectified_) {
      camera_ = cameraFromInfo(info, ImageKind::kRectified, size_);
    } else {
      lens_ = lensFromInfo(info, size_);
      camera_ = lens_->parameters().rectified;
    }
  } catch (const std::invalid_argument& error) {
    problem_ = error.what();
  }
  return another;
}

std::optional<Eigen::Vector2d> FeatureCamera::withoutLens(const Eigen::Vector2d& pixel) const {
  return lens_ ? lens_->toRectified(pixel) : pixel;
}

std::optional<Eigen::Vector2d> FeatureCamera::withLens(const Eigen::Vector2d& pixel) const {
  return lens_ ? lens_->toRaw(pixel) : pixel;
}

std::optional<Eigen::Vector2d> FeatureCamera::normalised(const Eigen::Vector2d& pixel) const {
  if (!pixel.allFinite()) return std::nullopt;
  const std::optional<Eigen::Vector2d> seen = withoutLens(pixel);
  if (!seen || !seen->allFinite()) return std::nullopt;
  return Eigen::Vector2d((camera_.inverseMatrix() * seen->homogeneous()).head<2>());
}

bool FeatureCamera::hasSizeOf(const TrackedFeatures& message) const {
  return static_cast<int>(message.width) == size_.width && static_cast<int>(message.height) == size_.height;
}

}  // namespace laparoscope_servo
