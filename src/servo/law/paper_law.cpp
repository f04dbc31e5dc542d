#include "servo/law/paper_law.h"

#include "laparoscope_servo/scope/insertion_point.h"

namespace laparoscope_servo::servo {

LawVelocity PaperLaw::velocity(const TaskError& error, const scope::Geometry& scope) const {
  // Eq. (7), plus signs: H maps the reference to the current image, so that e_v and e_w point back to the reference.
  // Here lambda_v = k_p d2 for pan and k_t d2 for tilt; eq. (11) divides by d2, so that k_p and k_t are rates in 1/s.
  const Eigen::Matrix3d shaft_R_camera = scope.camera_R_shaft.transpose();
  const Eigen::Vector3d v = shaft_R_camera * error.e_v;
  const Eigen::Vector3d w = shaft_R_camera * error.e_w;
  geometry::Vector6d centring, turning;
  centring << gains_.pan * scope.d2 * v.x(), gains_.tilt * scope.d2 * v.y(), gains_.insertion * v.z(), 0.0, 0.0,
      0.0;                                                                                                 // eq. (7)
  turning << 0.0, 0.0, 0.0, 0.0, 0.0, gains_.spin * w.z();                                                 // eq. (7)
  return {scope::aboutInsertionPoint(turning, scope.d2), scope::aboutInsertionPoint(centring, scope.d2)};  // eq. (11)
}

}  // namespace laparoscope_servo::servo
