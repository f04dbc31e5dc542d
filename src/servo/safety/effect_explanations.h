// What may stand between a motion of the scope and the motion seen in the picture: nothing, or one of the faults that
// the guard of effect knows.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace laparoscope_servo::servo {

struct EffectExplanation {
  std::string fault;                                      // in words that follow "as if it were"; empty: none
  Eigen::Matrix2d picture = Eigen::Matrix2d::Identity();  // of the picture over what it should be, orthogonal
  Eigen::Vector4d arm = Eigen::Vector4d::Ones();          // signs of what it does: pan, tilt, spin, insertion
  double late = 0.0;                                      // s, by which what is known of its motion comes late
  double reach = 1.0;                                     // of the motion in the picture, over what depths say
  bool frozen() const { return arm.isZero(); }
};

// Those without a fault allow for depths and a delay that are somewhat off.
std::vector<EffectExplanation> effectExplanations();

}  // namespace laparoscope_servo::servo
