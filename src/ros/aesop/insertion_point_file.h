// A calibrated insertion point as a YAML file: what it is, how well it is known, and the joint positions behind it.
#pragma once

#include <string>
#include <vector>

#include "laparoscope_servo/aesop/kinematics.h"

namespace laparoscope_servo {

struct CalibratedInsertionPoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       // m, in aesop_base
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // m²
  double stddev = 0.0;                                   // m, along the worst axis
  double residual = 0.0;                                 // m, root mean square distance of the shafts from the point
  double cone = 0.0;                      // rad, root mean square of the shafts' directions from their mean
  std::string method;                     // HAND or PATTERN
  std::string date;                       // UTC, ISO 8601
  std::vector<aesop::JointVector> poses;  // m, rad
};

// Now, by the machine's clock, as `date` has it.
std::string utcDate();

// m, root mean square distance of the shafts at `poses` from the point.
double residual(const aesop::Kinematics& kinematics, const std::vector<aesop::JointVector>& poses,
                const Eigen::Vector3d& point);

// Replaces the file as a whole or not at all. Throws std::runtime_error: which file, and what the system says.
void saveInsertionPoint(const std::string& file, const CalibratedInsertionPoint& calibrated);

// Throws std::runtime_error with everything that is wrong in the file, and when its poses do not give its residual:
// then it is from an arm of other kinematics.
CalibratedInsertionPoint loadInsertionPoint(const std::string& file, const aesop::Kinematics& kinematics);

}  // namespace laparoscope_servo
