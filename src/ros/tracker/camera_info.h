// Intrinsics and lens from sensor_msgs/CameraInfo, and checks whether they may be used.
#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/image/lens.h"

namespace laparoscope_servo {

// Kind of the images, and the matrix for the tracker's pixels.
enum class ImageKind {
  kRaw,        // raw images, used as those of a pinhole camera: K
  kRectified,  // rectified by image_proc: P
  kToRectify,  // raw images, rectified by the tracker: P
};

// The pinhole camera of an image of `size` [px]. Handles binning and the driver's region of the sensor. Throws
// std::invalid_argument, naming the value, if the focal lengths are zero, negative or not finite, the centre is not
// finite, either is implausible for this size, K and P are not of one calibration, the driver's region is not on the
// sensor, or the message is for images of another size. Ignores distortion. kToRectify uses K if P is all zero, as from
// drivers that know K and D only.
geometry::PinholeCamera cameraFromInfo(const sensor_msgs::CameraInfo& info, ImageKind kind, const cv::Size& size);

// The lens of raw images of `size` [px] by D, K, R and P. Throws std::invalid_argument, naming the value, for the
// reasons above, a model other than plumb_bob, rational_polynomial and equidistant, a number of coefficients that is
// not the model's, and values that are not finite. An R of zeros counts as the identity.
image::Lens lensFromInfo(const sensor_msgs::CameraInfo& info, const cv::Size& size);

// Compares all but the header, since the same camera_info comes with every image. A NaN never compares as equal.
bool sameCalibration(const sensor_msgs::CameraInfo& a, const sensor_msgs::CameraInfo& b);

// Reads a file of camera_calibration, YAML or INI. Throws std::runtime_error with the file's name.
sensor_msgs::CameraInfo readCameraInfo(const std::string& file);

// Keeps the lens of raw images from camera_info.
class LensSource {
 public:
  // The newest camera_info; it holds for the images that follow.
  void set(const sensor_msgs::CameraInfo& info);

  // The lens for the next image. Null if there is no usable one; error() then has the reason.
  const std::shared_ptr<const image::Lens>& lensFor(const cv::Size& size);
  const std::string& error() const { return error_; }

 private:
  std::optional<sensor_msgs::CameraInfo> info_;
  bool fresh_ = false;  // the newest camera_info has not been evaluated yet
  cv::Size size_;
  std::shared_ptr<const image::Lens> lens_;
  std::string error_ = "no camera_info has come";
};

// Keeps the intrinsics while a ROI is tracked. The homography in normalised coordinates needs the intrinsics of the
// reference image and those of the current one to be the same; if they change, a zoom cannot be distinguished from a
// new calibration, so H stays invalid until the ROI is selected again.
class Intrinsics {
 public:
  explicit Intrinsics(ImageKind kind) : kind_(kind) {}

  // The newest camera_info; it holds for the images that follow.
  void set(const sensor_msgs::CameraInfo& info) { info_ = info; }

  // Call for the next image. `new_reference`: the ROI was selected in it. Afterwards camera() and error() refer to that
  // image.
  void update(const cv::Size& size, bool new_reference);

  // Empty if there are no usable intrinsics; error() then has the reason.
  const std::optional<geometry::PinholeCamera>& camera() const { return camera_; }
  const std::string& error() const { return error_; }
  // Whether the camera has lens distortion and the images are not rectified.
  bool ignoresDistortion() const;

 private:
  ImageKind kind_;
  std::optional<sensor_msgs::CameraInfo> info_;
  std::optional<geometry::PinholeCamera> reference_;
  std::optional<geometry::PinholeCamera> camera_;
  std::string error_ = "no camera_info has come";
};

}  // namespace laparoscope_servo
