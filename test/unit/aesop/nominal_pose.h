// The nominal start pose of the emulated arm, for tests: tool pointing straight down, camera 0.1 m inside the trocar.
#pragma once

#include "laparoscope_servo/aesop/kinematics.h"

namespace laparoscope_servo::aesop {

inline JointVector joints(double q1, double q2, double q3, double q4, double q5, double q6, double q7) {
  JointVector q;
  q << q1, q2, q3, q4, q5, q6, q7;
  return q;
}

inline JointVector nominalPose() {
  return joints(0.25, -0.9, 1.5, 0.0, 0.0, 0.0, 0.0);
}

// On the shaft's line, d1 = 0.2 m ahead of O_7.
inline Eigen::Vector3d nominalTrocar() {
  return Kinematics(KinematicsConfig()).endEffector(nominalPose()) * Eigen::Vector3d(0.0, 0.0, 0.2);
}

}  // namespace laparoscope_servo::aesop
