// Where the axes of a shaft meet that turns about its trocar while the camera rests: the image of the trocar.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace laparoscope_servo::model {

class AxisMeeting {
 public:
  void reset();
  // A line of the image: through `point`, along `direction` (of length 1), px. Older ones are forgotten slowly.
  void add(const Eigen::Vector2d& point, const Eigen::Vector2d& direction);
  // Empty until the axes have turned by enough to tell, and when they do not meet in one point.
  std::optional<Eigen::Vector2d> point() const;

 private:
  Eigen::Matrix2d information_ = Eigen::Matrix2d::Zero();  // sum n n'
  Eigen::Vector2d right_ = Eigen::Vector2d::Zero();        // sum n rho
  double square_ = 0.0;                                    // sum rho^2
  double weight_ = 0.0;
};

}  // namespace laparoscope_servo::model
