// A surgical instrument in front of the tissue: a metal shaft with round ends and a thinner tip.
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/sim/light.h"
#include "laparoscope_servo/sim/scene_config.h"

namespace laparoscope_servo::sim {

// The points within `radius` [m] of the segment from a to b.
struct Capsule {
  Eigen::Vector3d a;
  Eigen::Vector3d b;
  double radius;
  cv::Vec3f colour;  // blue, green, red [grey levels] in the light at the reference distance
};

// Position of the tip in the tissue's frame [m], `elapsed` seconds after a crossing began; empty before and after it.
std::optional<Eigen::Vector3d> instrumentTip(const InstrumentConfig& config, double elapsed);

// The instrument with its tip at this point, in the tissue's frame.
std::vector<Capsule> instrumentAt(const InstrumentConfig& config, const Eigen::Vector3d& tip);

// Draws capsules, given in the camera's frame, over `image` (CV_8UC3), lit by the lamp with the exposure's gain. The
// outline is that of the capsule's perspective image, with a soft edge of a pixel. Sets `mask` (CV_8UC1, size of the
// image) to 255 where at least half of a pixel is covered. Parts nearer than 5 mm to the camera's plane are cut off.
void drawCapsules(const std::vector<Capsule>& capsules, const geometry::PinholeCamera& camera, const Lamp& lamp,
                  double gain, cv::Mat& image, cv::Mat& mask);

}  // namespace laparoscope_servo::sim
