// The task function: the error between current and reference image at the ROI.
//
// Bourger et al. (2007), eq. (6): e_v = (H - I) m*, [e_w]x = H - H'. H takes normalised points of the reference image
// to those of the current one and is scaled to R + t n'/d* (median singular value 1), so that e_v is the ROI's
// displacement over its depth. Also computes the features of the ROI for a law of four degrees of freedom: centre,
// depth, orientation. Camera frame: optical, x right, y down, z forward.
#pragma once

#include <Eigen/Core>

#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::servo {

struct TaskError {
  Eigen::Vector3d e_v = Eigen::Vector3d::Zero();  // dimensionless, (H - I) m*
  Eigen::Vector3d e_w = Eigen::Vector3d::Zero();  // dimensionless, 2 sin(angle) times the axis for a pure rotation
  Eigen::Vector3d m_star =
      Eigen::Vector3d::UnitZ();  // the ROI's centre in the reference image, normalised: (x*, y*, 1)

  double x = 0.0;  // the ROI's centre in the current image, normalised
  double y = 0.0;  // second coordinate of that centre
  double log_depth =
      0.0;  // log(Z/Z*), taken from the ROI's area: minus half the log of the area over that in the reference
  double alpha = 0.0;  // rad in (-pi, pi], rotation of the ROI in the image, positive from x (right) to y (down)
  double desired_x = 0.0;
  double desired_y = 0.0;
  double desired_log_depth = 0.0;
  double desired_alpha = 0.0;
};

// `h` at any scale and sign, reference to current, normalised coordinates; `roi` [px] in the reference image, at least
// two pixels a side. Throws std::invalid_argument, naming the value, when the camera, the ROI or h cannot be used: not
// finite, of rank below 2, or taking the ROI to something that is no convex quadrilateral (a mirrored one, or one
// through infinity).
TaskError taskError(const Eigen::Matrix3d& h, const geometry::Rectangle& roi, const geometry::PinholeCamera& camera);

// Whether all values are finite.
bool isFinite(const TaskError& error);

}  // namespace laparoscope_servo::servo
