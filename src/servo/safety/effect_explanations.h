// The hypotheses that relate the scope's motion to the motion in the picture: no fault, or one of the faults that the
// effect guard knows.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace laparoscope_servo::servo {

struct EffectExplanation {
  std::string fault;                                      // text that follows "as if it were"; empty: no fault
  Eigen::Matrix2d picture = Eigen::Matrix2d::Identity();  // takes the correct picture to the one seen, orthogonal
  Eigen::Vector4d arm = Eigen::Vector4d::Ones();          // signs of the executed pan, tilt, spin, insertion
  double late = 0.0;                                      // s, by which the known motion is late
  // ratio of the motion in the picture to that predicted from the depths
  double reach = 1.0;
  bool frozen() const { return arm.isZero(); }
};

// All hypotheses. Those without a fault allow for some error of depths and delay.
std::vector<EffectExplanation> effectExplanations();

}  // namespace laparoscope_servo::servo
