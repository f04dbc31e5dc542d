// Intrinsics and lens from sensor_msgs/CameraInfo, and whether they may be used.
#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/image/lens.h"

namespace laparoscope_servo {

// What the images are, and which of the matrices describes what the tracker finds in them.
enum class ImageKind {
  kRaw,        // the camera's, taken for a pinhole camera's: K
  kRectified,  // image_proc has rectified them: P
  kToRectify,  // the camera's, and the tracker rectifies what it looks at: P
};

// The pinhole camera of an image of `size` [px]. Takes care of binning and of the region that the driver cut out.
// Throws std::invalid_argument, naming the value, when the focal lengths are zero, negative or not finite, the centre
// is not finite, either is none that a camera of this size has, K and P are not of one calibration, the driver's region
// is not on the sensor, or the message is for images of another size. Distortion is not looked at. kToRectify takes K
// where P is all zero, as drivers leave it that know K and D only.
geometry::PinholeCamera cameraFromInfo(const sensor_msgs::CameraInfo& info, ImageKind kind, const cv::Size& size);

// The lens of raw images of `size` [px] by D, K, R and P. Throws std::invalid_argument, naming the value, for the
// reasons above, a model other than plumb_bob, rational_polynomial and equidistant, a number of coefficients that is
// not the model's, and values that are not finite. An R that is all zero is taken for the identity.
image::Lens lensFromInfo(const sensor_msgs::CameraInfo& info, const cv::Size& size);

// A file as camera_calibration writes it, YAML or INI. Throws std::runtime_error that names it.
sensor_msgs::CameraInfo readCameraInfo(const std::string& file);

// Follows camera_info for the lens of raw images.
class LensSource {
 public:
  // The newest camera_info; it holds for the images that follow.
  void set(const sensor_msgs::CameraInfo& info);

  // For the next image. Null when there is none that can be used; error() then says why.
  const std::shared_ptr<const image::Lens>& lensFor(const cv::Size& size);
  const std::string& error() const { return error_; }

 private:
  std::optional<sensor_msgs::CameraInfo> info_;
  bool fresh_ = false;  // not looked at yet
  cv::Size size_;
  std::shared_ptr<const image::Lens> lens_;
  std::string error_ = "no camera_info has come";
};

// Follows the camera while a ROI is tracked. The homography in normalised coordinates needs the intrinsics of the
// reference image and those of the current one to be the same; when they change, nothing can tell a zoom from a new
// calibration, so that H stays invalid until the ROI is selected again.
class Intrinsics {
 public:
  explicit Intrinsics(ImageKind kind) : kind_(kind) {}

  // The newest camera_info; it holds for the images that follow.
  void set(const sensor_msgs::CameraInfo& info) { info_ = info; }

  // For the next image: `new_reference` when the ROI was selected in it. Afterwards camera() and error() speak of that
  // image.
  void update(const cv::Size& size, bool new_reference);

  // Empty when there is none that can be used; error() then says why.
  const std::optional<geometry::PinholeCamera>& camera() const { return camera_; }
  const std::string& error() const { return error_; }
  // The camera has lens distortion, and the images are not rectified.
  bool ignoresDistortion() const;

 private:
  ImageKind kind_;
  std::optional<sensor_msgs::CameraInfo> info_;
  std::optional<geometry::PinholeCamera> reference_;
  std::optional<geometry::PinholeCamera> camera_;
  std::string error_ = "no camera_info has come";
};

}  // namespace laparoscope_servo
