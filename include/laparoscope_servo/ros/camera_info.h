// Intrinsics from sensor_msgs/CameraInfo, and whether they may be used.
#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "laparoscope_servo/geometry/camera.h"

namespace laparoscope_servo::skin {

// Which of its matrices describes the images: K those of the camera, P those that image_proc has rectified.
enum class ImageKind { kRaw, kRectified };

// The pinhole camera of an image of `size` [px]. Takes care of binning and of the region that the driver cut out.
// Throws std::invalid_argument, naming the value, when the focal lengths are zero, negative or not finite, the centre
// is not finite, or the message is for images of another size. Distortion is not looked at.
geometry::PinholeCamera cameraFromInfo(const sensor_msgs::CameraInfo& info, ImageKind kind, const cv::Size& size);

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

}  // namespace laparoscope_servo::skin
