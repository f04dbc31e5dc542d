#include "model/instrument/axis_meeting.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace laparoscope_servo::model {

namespace {

constexpr double kForget = 0.995;  // each image: 200 of them count
constexpr double kLeast = 30.0;    // images
// Smallest eigenvalue of the mean of n n': axes that spread by a standard deviation of a have sin(a)^2; 2.5 degrees.
constexpr double kSpread = 0.002;
constexpr double kScatter = 5.0;  // px, standard deviation of the axes about the point where they meet

}  // namespace

void AxisMeeting::reset() {
  *this = AxisMeeting();
}

void AxisMeeting::add(const Eigen::Vector2d& point, const Eigen::Vector2d& direction) {
  const Eigen::Vector2d n(-direction.y(), direction.x());
  const double rho = n.dot(point);
  information_ = kForget * information_ + n * n.transpose();
  right_ = kForget * right_ + n * rho;
  square_ = kForget * square_ + rho * rho;
  weight_ = kForget * weight_ + 1.0;
}

std::optional<Eigen::Vector2d> AxisMeeting::point() const {
  if (!(weight_ >= kLeast)) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(information_ / weight_);
  if (!(solver.eigenvalues()[0] >= kSpread)) return std::nullopt;
  const Eigen::Vector2d x = information_.inverse() * right_;
  const double variance = (square_ - 2.0 * x.dot(right_) + x.dot(information_ * x)) / weight_;
  if (!(std::sqrt(std::max(0.0, variance)) <= kScatter)) return std::nullopt;
  return x;
}

}  // namespace laparoscope_servo::model
