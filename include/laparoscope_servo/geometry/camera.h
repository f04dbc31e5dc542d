// The pinhole camera. Frame: optical, REP-103: x right, y down, z forward. The centre of the first pixel is (0, 0).
#pragma once

#include <Eigen/Core>
#include <string>

namespace laparoscope_servo::geometry {

struct PinholeCamera {
  double fx = 0.0;  // px
  double fy = 0.0;  // px
  double cx = 0.0;  // px
  double cy = 0.0;  // px

  // K, takes normalised points to pixels.
  Eigen::Matrix3d matrix() const;

  // K^-1, takes pixels to normalised points. Exact inverse of the form above; the camera must be valid.
  Eigen::Matrix3d inverseMatrix() const;

  // Why this camera cannot be used, naming the value: focal lengths must be finite and positive, the centre finite.
  // Empty if it can be used.
  std::string error() const;
};

// Exact comparison of all values; a camera with a NaN equals none.
bool operator==(const PinholeCamera& a, const PinholeCamera& b);
bool operator!=(const PinholeCamera& a, const PinholeCamera& b);

// From a row-major 3x3 camera matrix as in sensor_msgs/CameraInfo.K. Does not check the values: see error(). A skew is
// not represented, since camera calibration of ROS reports none.
PinholeCamera cameraFromRowMajor(const double* k);

}  // namespace laparoscope_servo::geometry
