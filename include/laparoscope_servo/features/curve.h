// What the edge stage asks of a curve: sites, and to be moved. Pixels; the centre of the first pixel is (0, 0).
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace laparoscope_servo::features {

constexpr double kFarthest = 1e5;  // px: of an image, and of whatever in or beside it

// A point of the curve at which an edge is searched along the normal.
struct Site {
  static constexpr int kMostCoefficients = 8;

  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  // of length 1
  // 1/px, positive where the curve's centre of curvature lies on the side that the normal points away from.
  double curvature = 0.0;
  // Of the curve's displacement along the normal here, by parameters first, first + 1, ...; after the last parameter
  // comes the first one.
  int first = 0;
  int count = 0;
  std::array<double, kMostCoefficients> jacobian{};
  int slot = 0;        // which piece of the curve this is, in every image: 0 to slots() - 1
  bool probe = false;  // beyond the curve's end: looked at, but no part of the fit
};

// Of a site, after a fit.
struct SiteFinding {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();  // px, on the fitted curve
  Eigen::Vector2d edge = Eigen::Vector2d::Zero();   // px, of the edge that was chosen; the point itself where none was
  double weight = 0.0;                              // 0 (no edge, or astray) to 1
  bool inside = false;                              // the image has pixels there
  bool probe = false;                               // beyond the curve's end
  int slot = 0;
};

class Curve {
 public:
  virtual ~Curve() = default;

  virtual int parameters() const = 0;
  virtual int slots() const = 0;
  // How many slots further on the curve still looks as it does at a slot. Where none so near has been seen, any edge
  // may be the curve's.
  virtual int likeSlots() const { return slots(); }
  // About `spacing` px apart, `most` of them at most, probes aside. Overwrites `result`.
  virtual void sites(double spacing, int most, std::vector<Site>& result) const = 0;
  // By a step of its parameters, which displaces each site along its normal by its jacobian times the step, to first
  // order.
  virtual void move(const Eigen::VectorXd& step) = 0;
  // By a homography, which takes pixels of where it was to pixels of where it is.
  virtual void transform(const Eigen::Matrix3d& motion) = 0;
  // What is known of the step from here to where the curve is in the image, when it was expected at `expected`, a curve
  // of the same kind: mean, and the inverse of its covariance. `range`, px, is how far a site may be from its edge.
  virtual void known(const Curve& expected, double range, Eigen::MatrixXd& information,
                     Eigen::VectorXd& mean) const = 0;
  // px, standard deviation: how far a piece of it may come to lie off where the rest of it says, from image to image. 0
  // where a few parameters move all of it.
  virtual double deformation() const { return 0.0; }
  // After an image that showed it, `passed` seconds after the one before, with the covariance of its parameters: where
  // its ends are, how well its shape is known.
  virtual void settle(const std::vector<SiteFinding>& findings, const Eigen::MatrixXd& covariance, double passed) = 0;
  // Finite, and of the kind that it claims to be.
  virtual bool isSound() const = 0;
  // Largest factor by which its size or shape differs from that of `before`, a curve of the same kind, at least 1.
  virtual double change(const Curve& before) const = 0;
};

}  // namespace laparoscope_servo::features
