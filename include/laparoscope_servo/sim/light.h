// The lamp, which sits at the camera, and the camera's exposure.
#pragma once

#include <opencv2/core.hpp>

#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/sim/scene_config.h"
#include "laparoscope_servo/sim/tissue.h"

namespace laparoscope_servo::sim {

// Brightness of a plane and of other surfaces under a lamp at the camera's centre: the cosine of the angle of incidence
// over the squared distance, times the falloff of beam and lens. 1 for a plane seen squarely at the reference distance,
// on the axis.
class Lamp {
 public:
  // `border_radius` [px]: black outside this circle round the image's middle, with a soft edge of a pixel; 0: none.
  Lamp(const LightConfig& config, const geometry::PinholeCamera& camera, const cv::Size& size, double border_radius);

  // Brightness per pixel, CV_32FC1; 0 where the ray does not meet the plane.
  cv::Mat1f onPlane(const Plane& plane) const;

  // Brightness of a surface seen squarely through pixel (u, v), at depth z > 0 [m]. The pixel must be in the image.
  float onSurface(int u, int v, double z) const;

 private:
  LightConfig config_;
  geometry::PinholeCamera camera_;
  cv::Mat1f falloff_;     // |m|^-(3 + beam exponent), 0 outside the border
  cv::Mat1f ray_length_;  // |m|, m = (x, y, 1)
};

// Automatic gain, as in cameras: follows the gain for which the image has its target mean, with a time constant.
class Exposure {
 public:
  explicit Exposure(const ExposureConfig& config) : config_(config), gain_(config.gain) {}

  // The gain for an image whose mean is `mean` grey levels at a gain of 1, taken at `time` [s]. The first image, and
  // one from before the last, gets its target at once.
  double update(double mean, double time);

 private:
  ExposureConfig config_;
  double gain_;
  bool started_ = false;
  double last_time_ = 0.0;
};

}  // namespace laparoscope_servo::sim
