// A piece of a straight line: x cos(theta) + y sin(theta) = rho (Marchand and Chaumette 2004, II.B.2).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "laparoscope_servo/features/curve.h"

namespace laparoscope_servo::features {

class Line : public Curve {
 public:
  static constexpr double kMinLength = 30.0;  // px

  Line() = default;
  // The normal (cos(theta), sin(theta)) is the direction from begin to end, (-sin(theta), cos(theta)), turned by
  // -90 degrees; rho may be negative. Throws std::invalid_argument, with the ends and what was expected, when they are
  // not finite or nearer than kMinLength.
  Line(const Eigen::Vector2d& begin, const Eigen::Vector2d& end);

  double rho() const { return normal().dot(anchor_); }  // px
  double theta() const { return theta_; }               // rad, (-pi, pi]
  // Where the image showed it to begin and to end, to the distance of two sites: its own end, an image's border, or
  // what covers it.
  Eigen::Vector2d begin() const { return at(seen_begin_); }
  Eigen::Vector2d end() const { return at(seen_end_); }
  double length() const { return seen_end_ - seen_begin_; }
  Eigen::Vector2d normal() const;
  Eigen::Vector2d direction() const;

  // Of (rho, theta): px^2, px rad, rad^2; from that of the curve's parameters.
  Eigen::Matrix2d covariance(const Eigen::MatrixXd& of_parameters) const;

  // Parameters: the displacement along the normal at the middle, px, and how much less of it there is at the end, px.
  int parameters() const override { return 2; }
  int slots() const override { return kSlots; }
  void sites(double spacing, int most, std::vector<Site>& result) const override;
  void move(const Eigen::VectorXd& step) override;
  void transform(const Eigen::Matrix3d& motion) override;
  void known(const Curve& expected, double range, Eigen::MatrixXd& information, Eigen::VectorXd& mean) const override;
  void settle(const std::vector<SiteFinding>& findings, const Eigen::MatrixXd& covariance, double passed) override;
  bool isSound() const override;
  double change(const Curve& before) const override;

 private:
  static constexpr int kSlots = 2048;

  Eigen::Vector2d at(double along) const { return anchor_ + along * direction(); }

  double theta_ = 0.0;
  Eigen::Vector2d anchor_ = Eigen::Vector2d::Zero();  // slots are counted from here
  // Where it is searched, px from the anchor: what was seen of it in the last second or so.
  double begin_ = 0.0;
  double end_ = 0.0;
  double seen_begin_ = 0.0;
  double seen_end_ = 0.0;
};

}  // namespace laparoscope_servo::features
