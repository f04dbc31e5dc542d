// Notices that a frame which stands still in its parent has been put somewhere else, as a calibration does: what was
// learnt in it before holds no more.
#pragma once

#include <tf2/buffer_core.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

namespace laparoscope_servo::skin {

class StaticFrameWatch {
 public:
  // Since the last call; by more than a micrometre or a microradian, or to another parent. A frame that is not known,
  // or not static, has not moved.
  bool moved(const tf2::BufferCore& tf, const std::string& frame);

 private:
  std::string parent_;
  std::optional<Eigen::Isometry3d> last_;
};

}  // namespace laparoscope_servo::skin
