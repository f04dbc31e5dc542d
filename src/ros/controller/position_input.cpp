#include "ros/controller/position_input.h"

#include <optional>

#include "laparoscope_servo/servo/position_error.h"
#include "ros/common/eigen_messages.h"

namespace laparoscope_servo {

void PositionInput::know(const TaskError& message) {
  region_ = message.reference_stamp;
  m_star_ = fromMessage(message.m_star);
}

servo::TaskErrorInput PositionInput::from(const Homography& message, const servo::DepthInput& depth) {
  servo::TaskErrorInput input;
  input.problem.clear();
  input.region = message.reference_stamp.toSec();
  if (message.state != Homography::TRACKING) return input;
  if (message.has_intrinsics == 0) {
    input.problem = "the homography of the region has no intrinsics: no usable camera_info reaches the tracker";
    return input;
  }
  if (region_.isZero() || message.reference_stamp != region_ || !m_star_.allFinite() || !(m_star_.z() > 0.0)) {
    input.problem = "the place of the region is not known: no task error of it was received";
    return input;
  }
  const std::optional<scope::Geometry>& scope = scope_.of(message.reference_stamp, depth);
  if (!scope) {
    input.problem = "depth d2 is unknown";
    return input;
  }
  const Eigen::Matrix3d h = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(message.h.data());
  const servo::PositionSeen seen = servo::positionError(h, m_star_, *scope, desired_depth_);
  if (!seen.is_known) {
    input.problem = "the homography of the region is of no plane before the camera";
    return input;
  }
  input.valid = true;
  input.error = seen.error;
  input.visible_fraction = message.visible_fraction;
  input.corner_error = message.corner_error;
  return input;
}

}  // namespace laparoscope_servo
