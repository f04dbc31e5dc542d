#include "ros/tracker/camera_info.h"

#include <camera_calibration_parsers/parse.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <tuple>

namespace laparoscope_servo {

namespace {

std::string text(const geometry::PinholeCamera& camera) {
  std::ostringstream stream;
  stream << "fx = " << camera.fx << ", fy = " << camera.fy << ", cx = " << camera.cx << ", cy = " << camera.cy;
  return stream.str();
}

// Binning of 0 means 1, and a region of interest of 0 x 0 means the whole image.
struct Axis {
  const char* name;
  std::uint64_t sensor;  // px; 0: not known, as with many drivers
  std::uint64_t offset;
  std::uint64_t region;  // the driver's region on the sensor [px]; 0: all of it
  std::uint64_t binning;
  std::uint64_t image;
  double focal_length;
  double centre;
};

std::string pair(std::uint64_t x, std::uint64_t y) {
  return std::to_string(x) + "x" + std::to_string(y);
}

void checkRegion(const Axis& axis) {
  std::ostringstream message;
  if (axis.offset > 0 && axis.region == 0) {
    message << "camera_info cannot be used: its roi begins at " << axis.name << " = " << axis.offset
            << " and has no size, expected one, or an offset of 0";
  } else if (axis.sensor > 0 && axis.offset + axis.region > axis.sensor) {
    message << "camera_info cannot be used: its roi ends at " << axis.name << " = " << axis.offset + axis.region
            << ", the sensor has " << axis.sensor << " px";
  }
  if (!message.str().empty()) throw std::invalid_argument(message.str());
}

// Size of the known part of the sensor: all of it, or the part that the image shows.
std::uint64_t sensorOf(const Axis& axis) {
  return axis.sensor > 0 ? axis.sensor : axis.offset + axis.image * axis.binning;
}

// A lens of 170 degrees has a focal length of 0.04 widths, one of 0.6 degrees 100. Its centre may lie beside the sensor
// where the image was shifted, but not by more than half of it.
void checkCamera(const Axis& axis, const char* matrix) {
  constexpr double kShortest = 0.04;
  constexpr double kLongest = 100.0;
  constexpr double kBeside = 0.5;
  const auto size = static_cast<double>(sensorOf(axis));
  std::ostringstream message;
  message << "camera_info cannot be used: " << matrix << ": ";
  if (!(axis.focal_length >= kShortest * size && axis.focal_length <= kLongest * size)) {
    message << "f" << axis.name << " = " << axis.focal_length << ", expected a focal length of " << kShortest * size
            << " to " << kLongest * size << " px for a sensor of " << size << " px";
  } else if (!(axis.centre >= -kBeside * size && axis.centre <= (1.0 + kBeside) * size)) {
    message << "c" << axis.name << " = " << axis.centre << ", expected a principal point from " << -kBeside * size
            << " to " << (1.0 + kBeside) * size << " px for a sensor of " << size << " px";
  } else {
    return;
  }
  throw std::invalid_argument(message.str());
}

// Rectification changes the focal length by less than this; matrices of two calibrations, or for two image sizes,
// differ by more.
void checkAgreement(const sensor_msgs::CameraInfo& info) {
  constexpr double kMostRatio = 2.5;
  for (const auto& [of_k, of_p, name] :
       {std::make_tuple(info.K[0], info.P[0], "fx"), std::make_tuple(info.K[4], info.P[5], "fy")}) {
    if (of_k == 0.0 || of_p == 0.0) continue;  // the driver gives only one of both
    const double ratio = of_p / of_k;
    if (ratio >= 1.0 / kMostRatio && ratio <= kMostRatio) continue;
    std::ostringstream message;
    message << "camera_info cannot be used: " << name << " is " << of_k << " in K, but " << of_p
            << " in P: they are not of one calibration";
    throw std::invalid_argument(message.str());
  }
}

bool allZero(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return value == 0.0; });
}

struct Model {
  const char* name;
  image::Distortion distortion;
  std::vector<std::size_t> counts;  // allowed numbers of coefficients; the rest is 0
};

const Model& modelOf(const sensor_msgs::CameraInfo& info) {
  // OpenCV's calibration may give plumb_bob without its fifth coefficient, and uncalibrated drivers give none.
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

}  // namespace

bool sameCalibration(const sensor_msgs::CameraInfo& a, const sensor_msgs::CameraInfo& b) {
  return a.width == b.width && a.height == b.height && a.distortion_model == b.distortion_model && a.D == b.D &&
         a.K == b.K && a.R == b.R && a.P == b.P && a.binning_x == b.binning_x && a.binning_y == b.binning_y &&
         a.roi.x_offset == b.roi.x_offset && a.roi.y_offset == b.roi.y_offset && a.roi.width == b.roi.width &&
         a.roi.height == b.roi.height;
}

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
  // Many drivers leave the sizes at 0; then only the other values can be compared.
  const bool has_size = info.width > 0 && info.height > 0;
  Axis x{"x",
         has_size ? info.width : 0,
         info.roi.x_offset,
         info.roi.width,
         std::max(1u, info.binning_x),
         static_cast<std::uint64_t>(size.width),
         camera.fx,
         camera.cx};
  Axis y{"y",
         has_size ? info.height : 0,
         info.roi.y_offset,
         info.roi.height,
         std::max(1u, info.binning_y),
         static_cast<std::uint64_t>(size.height),
         camera.fy,
         camera.cy};
  for (const Axis& axis : {x, y}) checkRegion(axis);
  const bool has_region = x.region > 0 && y.region > 0;
  if (has_size || has_region) {
    const std::uint64_t width = (x.region > 0 ? x.region : x.sensor) / x.binning;
    const std::uint64_t height = (y.region > 0 ? y.region : y.sensor) / y.binning;
    if (width != x.image || height != y.image) {
      std::string message = "camera_info is for images of " + pair(width, height);
      if (x.binning > 1 || y.binning > 1) message += " (binning " + pair(x.binning, y.binning) + ")";
      throw std::invalid_argument(message + ", the image has " + pair(x.image, y.image));
    }
  }
  for (const Axis& axis : {x, y}) checkCamera(axis, raw ? "K" : "P");
  checkAgreement(info);
  camera.fx /= static_cast<double>(x.binning);
  camera.fy /= static_cast<double>(y.binning);
  camera.cx = (camera.cx - static_cast<double>(x.offset)) / static_cast<double>(x.binning);
  camera.cy = (camera.cy - static_cast<double>(y.offset)) / static_cast<double>(y.binning);
  return camera;
}

image::Lens lensFromInfo(const sensor_msgs::CameraInfo& info, const cv::Size& size) {
  image::LensParameters parameters;
  parameters.raw = cameraFromInfo(info, ImageKind::kRaw, size);
  parameters.rectified = cameraFromInfo(info, ImageKind::kToRectify, size);
  const Model& model = modelOf(info);
  parameters.distortion = model.distortion;
  const bool uncalibrated = info.distortion_model.empty();  // D is then all zero, of any length
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
    if (camera != *reference_) {
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

}  // namespace laparoscope_servo
