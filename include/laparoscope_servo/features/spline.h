// A uniform cubic B-spline, closed or open, for contours that have no other form (Marchand and Chaumette 2004, II.B.3).
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "laparoscope_servo/features/curve.h"

namespace laparoscope_servo::features {

class Spline : public Curve {
 public:
  static constexpr int kLeastPoints = 6;
  static constexpr int kMostPoints = 48;
  static constexpr double kMinLength = 40.0;  // px

  Spline() = default;
  // Of its control points, px. Throws std::invalid_argument, with the value and what was expected, when they are too
  // few or many, not finite, or do not make a curve.
  Spline(const std::vector<Eigen::Vector2d>& control_points, bool closed);
  // The smooth curve through points on the contour, in their order, px: at least 4 of a closed one, 3 of an open one.
  // `control_points`: how many it shall have, and with that the detail that it follows; 0: one every 16 px, up to 32,
  // and at least as many as points are given. Throws as above.
  static Spline throughPoints(const std::vector<Eigen::Vector2d>& points, bool closed, int control_points = 0);

  bool isClosed() const { return closed_; }
  int size() const { return size_; }
  const Eigen::Vector2d& controlPoint(int k) const { return points_[static_cast<std::size_t>(k)]; }
  // Pieces between knots: `size()` of a closed one, three fewer of an open one.
  int pieces() const { return closed_ ? size_ : size_ - 3; }
  // The point at `t`, 0 to pieces().
  Eigen::Vector2d at(double t) const;
  double length() const;  // px

  // Of x and y of all control points, px^2, from that of the curve's parameters: none of it is along the curve.
  void spread(const Eigen::MatrixXd& of_parameters, Eigen::MatrixXd& result) const;

  // Parameters: of each control point the displacement along the curve's normal there, px. Along the curve an edge
  // shows none.
  int parameters() const override { return size_; }
  int slots() const override { return kSlots; }
  void sites(double spacing, int most, std::vector<Site>& result) const override;
  void move(const Eigen::VectorXd& step) override;
  void transform(const Eigen::Matrix3d& motion) override;
  // Its shape deforms little and smoothly from image to image, but for a similarity: so sites that see nothing keep to
  // their neighbours, and to where they were.
  void known(const Curve& expected, double range, Eigen::MatrixXd& information, Eigen::VectorXd& mean) const override;
  double deformation() const override { return deformation_; }
  void settle(const std::vector<SiteFinding>& findings, const Eigen::MatrixXd& covariance, double passed) override;
  bool isSound() const override;
  double change(const Curve& before) const override;

  using Points = std::array<Eigen::Vector2d, kMostPoints>;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostPoints, kMostPoints>;

 private:
  static constexpr int kSlots = 400;  // halved, it gives sets of sites that lie in each other
  static constexpr int kSteps = 4;    // of the table of lengths, each piece

  using Lengths = std::array<double, kMostPoints * kSteps + 1>;

  int wrapped(int k) const { return k < 0 ? k + size_ : k >= size_ ? k - size_ : k; }
  // Control point in front of the piece's first knot; the piece is made of it and the next three.
  int firstOf(int piece) const { return closed_ ? wrapped(piece - 1) : piece; }
  Eigen::Vector2d normal(int k) const;
  void lengths(Lengths& table) const;
  Site site(double t, const Points& normals) const;
  // The curve whose knots lie on `nodes`: as many as control points of a closed one, two fewer of an open one.
  void interpolate(const Points& nodes);
  void spaceEvenly();

  Points points_;
  int size_ = 0;
  bool closed_ = false;
  double deformation_ = 3.0;  // of a contour that a person has given
  Matrix information_;        // 1/px^2, of the shape in the next image; empty before the first one
};

}  // namespace laparoscope_servo::features
