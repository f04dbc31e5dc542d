#include "laparoscope_servo/servo/task_function.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo::servo {

namespace {

void checkRoi(const geometry::Rectangle& roi) {
  if (std::isfinite(roi.x) && std::isfinite(roi.y) && roi.width >= 2.0 && roi.height >= 2.0 &&
      std::isfinite(roi.width) && std::isfinite(roi.height)) {
    return;
  }
  std::ostringstream message;
  message << "region of interest x " << roi.x << ", y " << roi.y << ", width " << roi.width << ", height " << roi.height
          << " px, expected finite numbers and at least 2 px a side";
  throw std::invalid_argument(message.str());
}

geometry::Quadrilateral normalised(const geometry::Quadrilateral& pixels, const geometry::PinholeCamera& camera) {
  return geometry::apply(camera.inverseMatrix(), pixels);
}

// The rotation that best takes the corners of one quadrilateral to those of the other, both about their means. It uses
// the whole ROI, so that the effect of perspective, which turns opposite sides in opposite directions, cancels.
double rotation(const geometry::Quadrilateral& from, const geometry::Quadrilateral& to) {
  const Eigen::Vector2d from_mean = (from[0] + from[1] + from[2] + from[3]) / 4.0;
  const Eigen::Vector2d to_mean = (to[0] + to[1] + to[2] + to[3]) / 4.0;
  double sine = 0.0;
  double cosine = 0.0;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2d a = from[k] - from_mean;
    const Eigen::Vector2d b = to[k] - to_mean;
    sine += a.x() * b.y() - a.y() * b.x();
    cosine += a.dot(b);
  }
  return std::atan2(sine, cosine);
}

}  // namespace

TaskError taskError(const Eigen::Matrix3d& h, const geometry::Rectangle& roi, const geometry::PinholeCamera& camera) {
  const std::string camera_error = camera.error();
  if (!camera_error.empty()) throw std::invalid_argument(camera_error);
  checkRoi(roi);

  TaskError error;
  error.m_star = camera.inverseMatrix() * roi.centre().homogeneous();
  const Eigen::Matrix3d scaled = geometry::euclideanScale(h, error.m_star);
  const geometry::Quadrilateral reference = normalised(roi.corners(), camera);
  const geometry::Quadrilateral current = geometry::apply(scaled, reference);
  if (!((scaled * error.m_star).z() > 0.0)) {
    throw std::invalid_argument("homography takes the region of interest behind the camera");
  }
  if (!geometry::isConvex(current)) {
    throw std::invalid_argument("homography takes the region of interest to no convex quadrilateral");
  }

  error.e_v = (scaled - Eigen::Matrix3d::Identity()) * error.m_star;  // eq. (6)
  error.e_w = geometry::vee(scaled - scaled.transpose());             // eq. (6)

  const Eigen::Vector2d centre = geometry::apply(scaled, Eigen::Vector2d(error.m_star.head<2>()));
  error.x = centre.x();
  error.y = centre.y();
  error.log_depth = -0.5 * std::log(geometry::signedArea(current) / geometry::signedArea(reference));
  error.alpha = rotation(reference, current);
  error.desired_x = error.m_star.x();
  error.desired_y = error.m_star.y();
  if (!isFinite(error)) throw std::invalid_argument("task error is not finite for this homography");
  return error;
}

bool isFinite(const TaskError& error) {
  const double numbers[] = {error.x,         error.y,         error.log_depth,         error.alpha,
                            error.desired_x, error.desired_y, error.desired_log_depth, error.desired_alpha};
  for (const double number : numbers) {
    if (!std::isfinite(number)) return false;
  }
  return error.e_v.allFinite() && error.e_w.allFinite() && error.m_star.allFinite();
}

}  // namespace laparoscope_servo::servo
