// The task error of the whole view, from what the nodelet DominantMotion says and camera_info: the input of the task
// STABILISE.
#pragma once

#include <laparoscope_servo/TrackedFeatures.h>
#include <sensor_msgs/CameraInfo.h>

#include <optional>
#include <string>

#include "laparoscope_servo/servo/task_error_input.h"
#include "ros/tracker/camera_info.h"

namespace laparoscope_servo {

class ViewInput {
 public:
  // `rectified_images`: P of camera_info applies to the features' pixels; else K, and the lens is taken out.
  explicit ViewInput(bool rectified_images) : rectified_(rectified_images) {}

  // Takes a camera_info. Whether its calibration is another one than before; the first one is not.
  bool takeCameraInfo(const sensor_msgs::CameraInfo& info);

  // Of servo::viewRegion(), from the anchor image, on which the features were selected, to the image of the message.
  // Not valid unless the motion is TRACKING; `problem` says what is wrong with the message or the camera. The caller
  // fills in the ages.
  servo::TaskErrorInput from(const TrackedFeatures& message) const;

 private:
  servo::TaskError errorOf(const TrackedFeature& motion) const;

  bool rectified_;
  std::optional<sensor_msgs::CameraInfo> info_;
  cv::Size size_;  // of the images, by info_
  geometry::PinholeCamera camera_;
  std::optional<image::Lens> lens_;  // none: of rectified images
  std::string camera_problem_ = "no camera_info has come, which the view's motion needs";
};

}  // namespace laparoscope_servo
