#include "laparoscope_servo/ros/camera_info.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace laparoscope_servo::skin {

namespace {

std::string text(const geometry::PinholeCamera& camera) {
  std::ostringstream stream;
  stream << "fx = " << camera.fx << ", fy = " << camera.fy << ", cx = " << camera.cx << ", cy = " << camera.cy;
  return stream.str();
}

bool same(const geometry::PinholeCamera& a, const geometry::PinholeCamera& b) {
  return a.fx == b.fx && a.fy == b.fy && a.cx == b.cx && a.cy == b.cy;
}

// Binning of 0 means 1, as does a region of interest of 0 x 0 the whole image.
cv::Size imageSize(const sensor_msgs::CameraInfo& info) {
  const unsigned binning_x = std::max(1u, info.binning_x);
  const unsigned binning_y = std::max(1u, info.binning_y);
  const unsigned width = info.roi.width > 0 ? info.roi.width : info.width;
  const unsigned height = info.roi.height > 0 ? info.roi.height : info.height;
  return {static_cast<int>(width / binning_x), static_cast<int>(height / binning_y)};
}

}  // namespace

geometry::PinholeCamera cameraFromInfo(const sensor_msgs::CameraInfo& info, ImageKind kind, const cv::Size& size) {
  const bool raw = kind == ImageKind::kRaw;
  geometry::PinholeCamera camera;
  camera.fx = raw ? info.K[0] : info.P[0];
  camera.fy = raw ? info.K[4] : info.P[5];
  camera.cx = raw ? info.K[2] : info.P[2];
  camera.cy = raw ? info.K[5] : info.P[6];
  const std::string error = camera.error();
  if (!error.empty())
    throw std::invalid_argument(std::string("camera_info cannot be used: ") + (raw ? "K: " : "P: ") + error);
  // Many drivers leave the sizes at 0: then nothing can be compared.
  const cv::Size described = imageSize(info);
  if (info.width > 0 && info.height > 0 && described != size) {
    std::ostringstream message;
    message << "camera_info is for images of " << described.width << "x" << described.height << ", the image has "
            << size.width << "x" << size.height;
    throw std::invalid_argument(message.str());
  }
  const double binning_x = std::max(1u, info.binning_x);
  const double binning_y = std::max(1u, info.binning_y);
  camera.fx /= binning_x;
  camera.fy /= binning_y;
  camera.cx = (camera.cx - info.roi.x_offset) / binning_x;
  camera.cy = (camera.cy - info.roi.y_offset) / binning_y;
  return camera;
}

void Intrinsics::update(const cv::Size& size, bool new_reference) {
  camera_.reset();
  if (new_reference) reference_.reset();
  if (!info_) return;
  try {
    const geometry::PinholeCamera camera = cameraFromInfo(*info_, kind_, size);
    if (!reference_) reference_ = camera;
    if (!same(camera, *reference_)) {
      error_ = "the intrinsics changed since the ROI was selected, from " + text(*reference_) + " to " + text(camera) +
               ": select it again";
      return;
    }
    camera_ = camera;
    error_.clear();
  } catch (const std::invalid_argument& error) {
    error_ = error.what();
  }
}

bool Intrinsics::ignoresDistortion() const {
  return camera_ && kind_ == ImageKind::kRaw &&
         std::any_of(info_->D.begin(), info_->D.end(), [](double value) { return value != 0.0; });
}

}  // namespace laparoscope_servo::skin
