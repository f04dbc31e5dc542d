#include "laparoscope_servo/ros/camera_info.h"

#include <camera_calibration_parsers/parse.h>

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

bool allZero(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return value == 0.0; });
}

struct Model {
  const char* name;
  image::Distortion distortion;
  std::vector<std::size_t> counts;  // of coefficients; the rest is 0
};

const Model& modelOf(const sensor_msgs::CameraInfo& info) {
  // Calibrations by OpenCV give a plumb_bob without its fifth coefficient, and uncalibrated drivers none.
  static const Model models[] = {{"plumb_bob", image::Distortion::kPlumbBob, {5, 4, 0}},
                                 {"rational_polynomial", image::Distortion::kRationalPolynomial, {8, 0}},
                                 {"equidistant", image::Distortion::kEquidistant, {4}}};
  if (info.distortion_model.empty() && allZero(info.D)) return models[0];
  for (const Model& model : models) {
    if (info.distortion_model == model.name) return model;
  }
  throw std::invalid_argument("camera_info cannot be used: distortion_model '" + info.distortion_model +
                              "', expected plumb_bob, rational_polynomial or equidistant");
}

// But for the header, with which the same camera_info comes for every image. A NaN is never the same.
bool sameCalibration(const sensor_msgs::CameraInfo& a, const sensor_msgs::CameraInfo& b) {
  return a.width == b.width && a.height == b.height && a.distortion_model == b.distortion_model && a.D == b.D &&
         a.K == b.K && a.R == b.R && a.P == b.P && a.binning_x == b.binning_x && a.binning_y == b.binning_y &&
         a.roi.x_offset == b.roi.x_offset && a.roi.y_offset == b.roi.y_offset && a.roi.width == b.roi.width &&
         a.roi.height == b.roi.height;
}

}  // namespace

geometry::PinholeCamera cameraFromInfo(const sensor_msgs::CameraInfo& info, ImageKind kind, const cv::Size& size) {
  const bool has_p = std::any_of(info.P.begin(), info.P.end(), [](double value) { return value != 0.0; });
  const bool raw = kind == ImageKind::kRaw || (kind == ImageKind::kToRectify && !has_p);
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

image::Lens lensFromInfo(const sensor_msgs::CameraInfo& info, const cv::Size& size) {
  image::LensParameters parameters;
  parameters.raw = cameraFromInfo(info, ImageKind::kRaw, size);
  parameters.rectified = cameraFromInfo(info, ImageKind::kToRectify, size);
  const Model& model = modelOf(info);
  parameters.distortion = model.distortion;
  const bool uncalibrated = info.distortion_model.empty();  // D is all zero then, however long
  if (!uncalibrated && std::find(model.counts.begin(), model.counts.end(), info.D.size()) == model.counts.end()) {
    throw std::invalid_argument("camera_info cannot be used: D has " + std::to_string(info.D.size()) +
                                " coefficients, expected " + std::to_string(model.counts.front()) + " for " +
                                model.name);
  }
  if (!uncalibrated) std::copy(info.D.begin(), info.D.end(), parameters.coefficients.begin());
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation(info.R.data());
  if (!(rotation.array() == 0.0).all()) parameters.rotation = rotation;
  try {
    return image::Lens(parameters);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("camera_info cannot be used: ") + error.what());
  }
}

sensor_msgs::CameraInfo readCameraInfo(const std::string& file) {
  sensor_msgs::CameraInfo info;
  std::string name;
  if (!camera_calibration_parsers::readCalibration(file, name, info)) {
    throw std::runtime_error("'" + file + "' cannot be read, expected a calibration as camera_calibration writes it");
  }
  return info;
}

void LensSource::set(const sensor_msgs::CameraInfo& info) {
  if (info_ && sameCalibration(*info_, info)) return;
  info_ = info;
  fresh_ = true;
}

const std::shared_ptr<const image::Lens>& LensSource::lensFor(const cv::Size& size) {
  if (!info_ || (!fresh_ && size == size_)) return lens_;
  fresh_ = false;
  size_ = size;
  lens_.reset();
  error_.clear();
  try {
    lens_ = std::make_shared<const image::Lens>(lensFromInfo(*info_, size));
  } catch (const std::invalid_argument& error) {
    error_ = error.what();
  }
  return lens_;
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
