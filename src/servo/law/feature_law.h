// The law on the features (x, y, log depth, alpha) of the ROI, under the constraint of the insertion point.
//
// Four features for four degrees of freedom: each decays as exp(-rate t), the ROI's centre on a straight line in the
// image. A law of fewer degrees of freedom controls fewer features: the others are left alone, and cost the controlled
// ones nothing. Interaction matrix: Chaumette and Hutchinson, Visual servo control I (2006), for a point and a depth;
// the orientation is the mean over the ROI's directions.
#pragma once

#include "laparoscope_servo/servo/law_config.h"
#include "servo/law/control_law.h"

namespace laparoscope_servo::servo {

// Jacobian of the features by the scope's velocity: d(x, y, log depth, alpha)/dt = J (pan, tilt, spin, insertion).
// `depth` Z [m] > 0 of the ROI's centre now, `x`, `y` normalised.
Eigen::Matrix4d featureJacobian(double x, double y, double depth, const scope::Geometry& scope);

// The inverse of the part of `jacobian`, as above, that belongs to these degrees of freedom and to their features;
// the rows and columns of the others are zero.
Eigen::Matrix4d inverseOf(const Eigen::Matrix4d& jacobian, const LawAxes& axes);

// The shorter way round for a turn [rad]; the turn itself if both ways are about equally long.
double shortTurn(double turn);

// Z [m] from the log depth of the features.
double depthOf(const TaskError& error, double desired_depth);

class FeatureLaw : public ControlLaw {
 public:
  explicit FeatureLaw(const FeatureGains& gains, const LawAxes& axes = {}) : gains_(gains), axes_(axes) {}
  LawVelocity velocity(const TaskError& error, const scope::Geometry& scope) const override;

 private:
  FeatureGains gains_;
  LawAxes axes_;
};

}  // namespace laparoscope_servo::servo
