#include "ros/controller/selection_scope.h"

namespace laparoscope_servo {

const std::optional<scope::Geometry>& SelectionScope::of(const ros::Time& selection, const servo::DepthInput& depth) {
  if (selection != selection_) scope_.reset();
  selection_ = selection;
  const bool is_known = depth.problem.empty() && depth.d2 > 0.0;
  if (!scope_ && is_known) scope_ = scope::Geometry{depth.camera_R_shaft, depth.d2};
  return scope_;
}

}  // namespace laparoscope_servo
