// The camera behind the pixels of a tracker's features, by camera_info.
#pragma once

#include <laparoscope_servo/TrackedFeatures.h>
#include <sensor_msgs/CameraInfo.h>

#include <optional>
#include <string>

#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/image/lens.h"
#include "ros/tracker/camera_info.h"

namespace laparoscope_servo {

class FeatureCamera {
 public:
  // `rectified_images`: P of camera_info applies to the features' pixels; else K, and the lens is taken out.
  explicit FeatureCamera(bool rectified_images) : rectified_(rectified_images) {}

  // Takes a camera_info. Whether its calibration is another one than before; the first one is not.
  bool take(const sensor_msgs::CameraInfo& info);

  // Why the camera cannot be used; empty: it can. The rest is valid only then.
  const std::string& problem() const { return problem_; }
  const cv::Size& size() const { return size_; }  // px, of the images
  // Of pixels without the lens.
  const geometry::PinholeCamera& camera() const { return camera_; }
  // To pixels without the lens, and back; empty outside of what the lens shows.
  std::optional<Eigen::Vector2d> withoutLens(const Eigen::Vector2d& pixel) const;
  std::optional<Eigen::Vector2d> withLens(const Eigen::Vector2d& pixel) const;
  // To the normalised place without the lens; empty outside of what the lens shows, and of what is not finite.
  std::optional<Eigen::Vector2d> normalised(const Eigen::Vector2d& pixel) const;
  // Whether its images are those that the message is of.
  bool hasSizeOf(const TrackedFeatures& message) const;

 private:
  bool rectified_;
  std::optional<sensor_msgs::CameraInfo> info_;
  cv::Size size_;
  geometry::PinholeCamera camera_;
  std::optional<image::Lens> lens_;  // none: of rectified images
  std::string problem_ = "no camera_info has come, which the features of the task need";
};

}  // namespace laparoscope_servo
