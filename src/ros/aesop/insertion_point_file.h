// The YAML file of a calibrated insertion point: the point, its uncertainty, and the joint positions from which it was
// computed.
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

// The present time by the machine's clock, in the form of `date`.
std::string utcDate();

// m, root mean square distance of the shafts at `poses` from the point.
double residual(const aesop::Kinematics& kinematics, const std::vector<aesop::JointVector>& poses,
                const Eigen::Vector3d& point);

// Replaces the file as a whole or not at all. Throws std::runtime_error with the file and the system's error.
void saveInsertionPoint(const std::string& file, const CalibratedInsertionPoint& calibrated);

// Throws std::runtime_error with all errors of the file, and also if its poses do not give its residual, since it is
// then from an arm of other kinematics.
CalibratedInsertionPoint loadInsertionPoint(const std::string& file, const aesop::Kinematics& kinematics);

}  // namespace laparoscope_servo
