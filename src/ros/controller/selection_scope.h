// The scope as it was when the error of a selection was told first, for errors that are computed by it.
#pragma once

#include <ros/time.h>

#include <optional>

#include "laparoscope_servo/scope/geometry.h"
#include "laparoscope_servo/servo/controller.h"

namespace laparoscope_servo {

class SelectionScope {
 public:
  // Kept until the selection changes: the error's digits must not change with the noise of the scope's pose, or a
  // picture that repeats would not show (repeat_watch.h). An error of d2 changes the speed only. Empty as long as d2 is
  // unknown.
  const std::optional<scope::Geometry>& of(const ros::Time& selection, const servo::DepthInput& depth);

 private:
  ros::Time selection_;
  std::optional<scope::Geometry> scope_;
};

}  // namespace laparoscope_servo
