// The law of the features (x, y, log depth, alpha) of the ROI, under the constraint of the insertion point.
//
// Four features for four degrees of freedom: each decays as exp(-rate t), the ROI's centre on a straight line in the
// image. Interaction matrix: Chaumette and Hutchinson, Visual servo control I (2006), for a point and a depth; the
// orientation is the mean over the ROI's directions.
#pragma once

#include "laparoscope_servo/servo/control_law.h"

namespace laparoscope_servo::servo {

struct FeatureGains {
  double centre = 8.0;       // 1/s, of x and y
  double depth = 8.0;        // 1/s, of log depth
  double orientation = 8.0;  // 1/s, of alpha
  double desired_depth =
      0.08;  // m, Z*: from the camera to the tissue at the reference; wrong by a factor, it changes how fast
};

// What becomes of the orientation.
enum class SpinMode {
  kServo,     // that of the ROI is servoed
  kUpright,   // that of the picture is: what is up in space is up in it
  kReleased,  // left as it comes: the scope does not spin
};

// The features' velocity per velocity of the scope: d(x, y, log depth, alpha)/dt = J (pan, tilt, spin, insertion).
// `depth` Z [m] > 0 of the ROI's centre now, `x`, `y` normalised.
Eigen::Matrix4d featureJacobian(double x, double y, double depth, const scope::Geometry& scope);

// rad, of a turn: the shorter way round, unless both are about as long.
double shortTurn(double turn);

// Z [m] from the log depth of the features.
double depthOf(const TaskError& error, double desired_depth);

class FeatureLaw : public ControlLaw {
 public:
  explicit FeatureLaw(const FeatureGains& gains, SpinMode spin = SpinMode::kServo) : gains_(gains), spin_(spin) {}
  LawVelocity velocity(const TaskError& error, const scope::Geometry& scope) const override;

 private:
  FeatureGains gains_;
  SpinMode spin_;
};

}  // namespace laparoscope_servo::servo
