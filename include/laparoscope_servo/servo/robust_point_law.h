// The robust law of visual servoing on points, v = -lambda (D L)^+ D e (Marchand and Chaumette 2004, II.C), under the
// constraint of the insertion point: points that were taken for others have no say.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "laparoscope_servo/robust/irls.h"
#include "laparoscope_servo/scope/geometry.h"
#include "laparoscope_servo/scope/velocity.h"

namespace laparoscope_servo::servo {

struct PointTask {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();    // normalised: x, y of where it is seen
  Eigen::Vector2d desired = Eigen::Vector2d::Zero();  // normalised: where it shall be seen
  double depth = 0.0;                                 // m, Z > 0 of the point now
  double weight = 1.0;                                // what is known of it beforehand, 0: is not used
};

struct RobustPointGains {
  double rate = 0.5;        // 1/s, lambda: the errors decay as exp(-rate t)
  double min_noise = 5e-4;  // normalised, standard deviation of a point: half a pixel at a focal length of 1000 px
};

struct RobustPointVelocity {
  bool is_determined = false;  // false: fewer than two points of finite values, or they do not fix the four velocities
  scope::Velocity velocity;    // zero unless determined
  double sigma = 0.0;          // normalised, robust standard deviation of what the velocity leaves of the errors
};

// The two rows of L for a point, by the scope's velocity: d(x, y)/dt = rows (pan, tilt, spin, insertion).
Eigen::Matrix<double, 2, 4> pointJacobian(const Eigen::Vector2d& point, double depth, const scope::Geometry& scope);

class RobustPointLaw {
 public:
  explicit RobustPointLaw(const RobustPointGains& gains) : gains_(gains) {}

  // Does not allocate for up to as many points as before.
  RobustPointVelocity velocity(const std::vector<PointTask>& points, const scope::Geometry& scope);

  // D of the last call, of each point: 0 (astray) to 1, the smaller one of its two coordinates.
  const std::vector<double>& weights() const { return weights_; }

 private:
  RobustPointGains gains_;
  robust::Irls irls_;
  std::vector<robust::Row> rows_;
  std::vector<double> weights_;
};

}  // namespace laparoscope_servo::servo
