#include "laparoscope_servo/geometry/camera.h"

#include <cmath>
#include <sstream>

namespace laparoscope_servo::geometry {

Eigen::Matrix3d PinholeCamera::matrix() const {
  Eigen::Matrix3d k;
  k << fx, 0.0, cx,  //
      0.0, fy, cy,   //
      0.0, 0.0, 1.0;
  return k;
}

Eigen::Matrix3d PinholeCamera::inverseMatrix() const {
  Eigen::Matrix3d k;
  k << 1.0 / fx, 0.0, -cx / fx,  //
      0.0, 1.0 / fy, -cy / fy,   //
      0.0, 0.0, 1.0;
  return k;
}

std::string PinholeCamera::error() const {
  std::ostringstream message;
  // !(x > 0) also catches NaN.
  if (!(fx > 0.0) || !(fy > 0.0) || !std::isfinite(fx) || !std::isfinite(fy)) {
    message << "camera matrix has focal lengths (" << fx << ", " << fy << ") px, expected finite and positive";
  } else if (!std::isfinite(cx) || !std::isfinite(cy)) {
    message << "camera matrix has the principal point (" << cx << ", " << cy << ") px, expected finite";
  }
  return message.str();
}

bool operator==(const PinholeCamera& a, const PinholeCamera& b) {
  return a.fx == b.fx && a.fy == b.fy && a.cx == b.cx && a.cy == b.cy;
}

bool operator!=(const PinholeCamera& a, const PinholeCamera& b) {
  return !(a == b);
}

PinholeCamera cameraFromRowMajor(const double* k) {
  return {k[0], k[4], k[2], k[5]};
}

}  // namespace laparoscope_servo::geometry
