// An ellipse, or an arc of one: x^2 + K1 y^2 + 2 K2 x y + 2 K3 x + 2 K4 y + K5 = 0 (Marchand and Chaumette 2004,
// II.B.2).
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "laparoscope_servo/features/curve.h"

namespace laparoscope_servo::features {

// K1 to K5 of the survey's equation, x and y in px. K2^2 < K1.
using EllipseCoefficients = Eigen::Matrix<double, 5, 1>;

class Ellipse : public Curve {
 public:
  static constexpr double kMinRadius = 3.0;  // px
  static constexpr double kMinArc = 0.7;     // rad: a shorter arc does not tell its ellipse

  Ellipse() = default;
  // `angle`, rad, from the image's x axis to the axis of radius `a`, towards y. Throws std::invalid_argument, with the
  // value and what was expected, for what is not finite, and radii below kMinRadius.
  Ellipse(const Eigen::Vector2d& centre, double a, double b, double angle);
  // Throws std::invalid_argument when they are no ellipse: K1 > K2^2 and a real one.
  static Ellipse fromCoefficients(const EllipseCoefficients& k);
  // The ellipse next to five points or more, px. Throws std::invalid_argument when there is none.
  static Ellipse throughPoints(const std::vector<Eigen::Vector2d>& points);

  // Only the part from the direction `begin` on, over `extent` rad towards growing angles: those of the points as seen
  // from the centre, in an image in which the ellipse is a circle. Throws std::invalid_argument unless `extent` is in
  // [kMinArc, 2 pi].
  void setArc(double begin, double extent);

  const Eigen::Vector2d& centre() const { return centre_; }
  double majorRadius() const;  // px
  double minorRadius() const;  // px
  double angle() const;        // rad, (-pi/2, pi/2], of the major axis
  EllipseCoefficients coefficients() const;
  // Of K1 to K5, from that of the curve's parameters.
  Eigen::Matrix<double, 5, 5> covariance(const Eigen::MatrixXd& of_parameters) const;
  double arcBegin() const { return arc_begin_; }    // rad, see setArc
  double arcExtent() const { return arc_extent_; }  // rad
  Eigen::Vector2d at(double phi) const { return centre_ + shape_ * Eigen::Vector2d(std::cos(phi), std::sin(phi)); }

  // Parameters: of the centre x, y; of the symmetric matrix that takes the unit circle to the ellipse xx, yy, xy. px.
  int parameters() const override { return 5; }
  int slots() const override { return kSlots; }
  void sites(double spacing, int most, std::vector<Site>& result) const override;
  void move(const Eigen::VectorXd& step) override;
  void transform(const Eigen::Matrix3d& motion) override;
  void known(const Curve& expected, double range, Eigen::MatrixXd& information, Eigen::VectorXd& mean) const override;
  void settle(const std::vector<SiteFinding>& findings, const Eigen::MatrixXd& covariance, double passed) override;
  bool isSound() const override;
  double change(const Curve& before) const override;

 private:
  static constexpr int kSlots = 256;

  Site site(double phi) const;
  void displace(const Eigen::Matrix<double, 5, 1>& step);

  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d shape_ = Eigen::Matrix2d::Identity();  // symmetric, positive
  double arc_begin_ = 0.0;
  double arc_extent_ = 6.283185307179586;
  Eigen::Matrix3d shape_information_ =
      Eigen::Matrix3d::Zero();  // 1/px^2, of the last three parameters in the next image
};

}  // namespace laparoscope_servo::features
