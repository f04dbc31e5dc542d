// Rigid motions and their velocities.
//
// Transforms are named a_T_b: they take coordinates in b to coordinates in a. A twist is (v, w): the velocity of the
// frame's origin [m/s] and the angular velocity [rad/s], both expressed in the frame that the comment names.
#pragma once

#include <Eigen/Geometry>

namespace laparoscope_servo::geometry {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// [w]x, the matrix with skew(w) u = w x u.
Eigen::Matrix3d skew(const Eigen::Vector3d& w);

// The inverse of skew for a skew-symmetric matrix; of another matrix it takes the skew-symmetric part.
Eigen::Vector3d vee(const Eigen::Matrix3d& m);

// exp([w]x), the rotation by |w| rad about w.
Eigen::Matrix3d so3Exp(const Eigen::Vector3d& w);

// The rotation vector, its norm in [0, pi] rad. `r` must be a rotation matrix.
Eigen::Vector3d so3Log(const Eigen::Matrix3d& r);

// The rotation R with the least |R - m|.
Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& m);

// In [0, pi] rad, exact for small angles, too; 0 where one of both is zero.
double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

// The motion of a frame that keeps the twist (v, w), expressed in the frame itself, for one unit of time: a_T_b becomes
// a_T_b * se3Exp(twist * dt).
Eigen::Isometry3d se3Exp(const Vector6d& twist);

// For one rigid body and a fixed transform a_T_b between two frames on it: takes the twist of frame b expressed in b to
// the twist of frame a expressed in a.
Matrix6d twistTransform(const Eigen::Isometry3d& a_T_b);

}  // namespace laparoscope_servo::geometry
