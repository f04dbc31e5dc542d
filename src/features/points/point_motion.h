// The motion of points that are seen, which leads those that are not: a similarity by robust least squares, and how
// the neighbours differ from it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "laparoscope_servo/robust/irls.h"

namespace laparoscope_servo::features {

class PointMotion {
 public:
  // `window`: px, side of the windows that are compared: the unit of what is near, and of how much tissue deforms.
  explicit PointMotion(double window) : reach_(3.0 * window), deformation_(0.1 * window) {}

  // Nothing is allocated for so many points.
  void reserve(int points);
  void clear();
  void add(const Eigen::Vector2d& from, const Eigen::Vector2d& to);
  int count() const { return static_cast<int>(from_.size()); }
  // False, with the identity as the motion, when there are no points.
  bool fit();

  // Of the last fit().
  Eigen::Vector2d apply(const Eigen::Vector2d& p) const;
  const Eigen::Matrix2d& linear() const { return linear_; }
  // Whether the k-th point that was added moves with the others.
  bool agrees(int k) const;
  // px, robust standard deviation of what the similarity leaves.
  double sigma() const { return sigma_; }

 private:
  void propose();
  Eigen::Vector2d similarity(const Eigen::Vector2d& p) const { return shift_ + centre_ + linear_ * (p - centre_); }

  double weight(std::size_t k) const;

  double reach_;        // px, the distance at which a neighbour's say has fallen to a quarter
  double deformation_;  // px, standard deviation of single points from a similarity, at least
  std::vector<Eigen::Vector2d> from_, to_;
  std::vector<robust::Row> rows_;
  std::vector<double> scratch_;
  robust::Irls irls_;
  Eigen::MatrixXd information_;
  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero(), shift_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d linear_ = Eigen::Matrix2d::Identity();
  double sigma_ = 0.0;
};

}  // namespace laparoscope_servo::features
