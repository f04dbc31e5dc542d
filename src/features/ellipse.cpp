#include "laparoscope_servo/features/ellipse.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace laparoscope_servo::features {

namespace {

constexpr double kTurn = 6.283185307179586;
constexpr double kChange = 0.007;     // of the radii, standard deviation, within
constexpr double kChangeTime = 0.04;  // s
constexpr double kLeastChange = 0.2;  // px
constexpr int kArcSteps = 64;         // of the table of arc lengths

using Eigen2d = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>;  // eigenvalues ascending

Eigen2d decomposed(const Eigen::Matrix2d& m) {
  Eigen2d solver;
  solver.computeDirect(m);
  return solver;
}

// p'Mp = 0, p = (x, y, 1), of x^2 + K1 y^2 + ...
Eigen::Matrix3d conic(const EllipseCoefficients& k) {
  Eigen::Matrix3d m;
  m << 1.0, k[1], k[2], k[1], k[0], k[3], k[2], k[3], k[4];
  return m;
}

// Centre and matrix of the ellipse of a conic of either sign; false when it is none.
bool split(Eigen::Matrix3d m, Eigen::Vector2d& centre, Eigen::Matrix2d& shape) {
  if (m(0, 0) + m(1, 1) < 0.0) m = -m;
  const Eigen::Matrix2d quadratic = m.topLeftCorner<2, 2>();
  if (!(quadratic.determinant() > 0.0)) return false;
  const Eigen::Vector2d linear = m.topRightCorner<2, 1>();
  centre = -quadratic.inverse() * linear;
  const double size = -(linear.dot(centre) + m(2, 2));
  if (!(size > 0.0)) return false;
  const Eigen2d axes = decomposed(quadratic / size);
  if (!(axes.eigenvalues()[0] > 0.0)) return false;
  shape = axes.eigenvectors() * axes.eigenvalues().cwiseInverse().cwiseSqrt().asDiagonal() *
          axes.eigenvectors().transpose();
  return centre.allFinite() && shape.allFinite();
}

std::string refused(const std::string& what, double value, const std::string& expected) {
  std::ostringstream text;
  text << "ellipse: " << what << " = " << value << ", expected " << expected;
  return text.str();
}

}  // namespace

Ellipse::Ellipse(const Eigen::Vector2d& centre, double a, double b, double angle) : centre_(centre) {
  for (const double value : {centre.x(), centre.y(), angle}) {
    if (!std::isfinite(value)) throw std::invalid_argument(refused("centre or angle", value, "a finite number"));
  }
  for (const double radius : {a, b}) {
    if (radius >= kMinRadius && radius < 1e5) continue;
    throw std::invalid_argument(refused("radius", radius, "3 px to 100000 px"));
  }
  const double c = std::cos(angle), s = std::sin(angle);
  Eigen::Matrix2d turn;
  turn << c, -s, s, c;
  shape_ = turn * Eigen::Vector2d(a, b).asDiagonal() * turn.transpose();
}

Ellipse Ellipse::fromCoefficients(const EllipseCoefficients& k) {
  Ellipse result;
  if (!k.allFinite() || !split(conic(k), result.centre_, result.shape_) || !result.isSound()) {
    std::ostringstream text;
    text << "ellipse of the coefficients " << k.transpose() << ", expected K1 > K2^2 and radii of at least "
         << kMinRadius << " px";
    throw std::invalid_argument(text.str());
  }
  return result;
}

Ellipse Ellipse::throughPoints(const std::vector<Eigen::Vector2d>& points) {
  if (points.size() < 5) {
    throw std::invalid_argument(refused("points", static_cast<double>(points.size()), "at least 5"));
  }
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : points) centre += point / static_cast<double>(points.size());
  double size = 0.0;
  for (const Eigen::Vector2d& point : points) {
    size += (point - centre).norm() / static_cast<double>(points.size());
  }
  if (!(size > 0.0 && std::isfinite(size))) {
    throw std::invalid_argument(refused("mean distance of the points", size, "a positive number"));
  }
  // The smallest singular value's conic, about the points' centre and in units of their size; of any sign of its parts,
  // so that it may be no ellipse.
  Eigen::Matrix<double, 6, 6> sums = Eigen::Matrix<double, 6, 6>::Zero();
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector2d p = (point - centre) / size;
    Eigen::Matrix<double, 6, 1> row;
    row << p.x() * p.x(), p.y() * p.y(), 2.0 * p.x() * p.y(), 2.0 * p.x(), 2.0 * p.y(), 1.0;
    sums += row * row.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(sums);
  const Eigen::Matrix<double, 6, 1> k = solver.eigenvectors().col(0);
  Eigen::Matrix3d m;
  m << k[0], k[2], k[3], k[2], k[1], k[4], k[3], k[4], k[5];
  Ellipse result;
  if (!split(m, result.centre_, result.shape_)) {
    throw std::invalid_argument("ellipse: the points lie on a line, a hyperbola or at random, expected on an ellipse");
  }
  result.centre_ = centre + size * result.centre_;
  result.shape_ *= size;
  if (!result.isSound()) throw std::invalid_argument(refused("radius", result.minorRadius(), "3 px to 100000 px"));
  return result;
}

void Ellipse::setArc(double begin, double extent) {
  if (!(std::isfinite(begin) && extent >= kMinArc && extent <= kTurn + 1e-9)) {
    throw std::invalid_argument(refused("arc", extent, "0.7 rad to a whole turn, from a finite angle"));
  }
  arc_begin_ = begin;
  arc_extent_ = extent;
}

double Ellipse::majorRadius() const {
  return decomposed(shape_).eigenvalues()[1];
}

double Ellipse::minorRadius() const {
  return decomposed(shape_).eigenvalues()[0];
}

double Ellipse::angle() const {
  const Eigen::Vector2d axis = decomposed(shape_).eigenvectors().col(1);
  double angle = std::atan2(axis.y(), axis.x());
  if (angle > 0.25 * kTurn) angle -= 0.5 * kTurn;
  if (angle <= -0.25 * kTurn) angle += 0.5 * kTurn;
  return angle;
}

EllipseCoefficients Ellipse::coefficients() const {
  const Eigen::Matrix2d e = (shape_ * shape_).inverse();
  const Eigen::Vector2d linear = -e * centre_;
  EllipseCoefficients k;
  k << e(1, 1), e(0, 1), linear.x(), linear.y(), centre_.dot(e * centre_) - 1.0;
  return k / e(0, 0);
}

Eigen::Matrix<double, 5, 5> Ellipse::covariance(const Eigen::MatrixXd& of_parameters) const {
  constexpr double kStep = 1e-4;  // px
  Eigen::Matrix<double, 5, 5> derivative;
  for (int k = 0; k < 5; ++k) {
    Ellipse more = *this, less = *this;
    const Eigen::Matrix<double, 5, 1> step = kStep * Eigen::Matrix<double, 5, 1>::Unit(k);
    more.displace(step);
    less.displace(-step);
    derivative.col(k) = (more.coefficients() - less.coefficients()) / (2.0 * kStep);
  }
  const Eigen::Matrix<double, 5, 5> own = of_parameters;  // of fixed size: the product does not allocate
  return derivative * own * derivative.transpose();
}

// The point c + S u moves by dc + dS u; its normal is along S^-1 u.
Site Ellipse::site(double phi) const {
  const Eigen::Vector2d u(std::cos(phi), std::sin(phi));
  const Eigen::Vector2d tangent = shape_ * Eigen::Vector2d(-u.y(), u.x());
  const double speed = tangent.norm();
  Site site;
  site.point = centre_ + shape_ * u;
  site.normal = Eigen::Vector2d(tangent.y(), -tangent.x()) / speed;
  site.curvature = shape_.determinant() / (speed * speed * speed);
  site.count = 5;
  const Eigen::Vector2d& n = site.normal;
  site.jacobian = {n.x(), n.y(), n.x() * u.x(), n.y() * u.y(), n.x() * u.y() + n.y() * u.x()};
  return site;
}

void Ellipse::sites(double spacing, int most, std::vector<Site>& result) const {
  result.clear();
  // Lengths of the arc up to each step, by the middle of its pieces.
  std::array<double, kArcSteps + 1> length{};
  const double piece = arc_extent_ / kArcSteps;
  for (int k = 0; k < kArcSteps; ++k) {
    const double phi = arc_begin_ + (k + 0.5) * piece;
    const double speed = (shape_ * Eigen::Vector2d(-std::sin(phi), std::cos(phi))).norm();
    length[static_cast<std::size_t>(k + 1)] = length[static_cast<std::size_t>(k)] + speed * piece;
  }
  const double whole = length[kArcSteps];
  // A power of two, so that a coarse set's slots are among those of a fine one.
  int count = kSlots;
  while (count > 16 && (count > most || whole / count < spacing)) count /= 2;
  int k = 0;
  for (int i = 0; i < count; ++i) {
    const double at = (i + 0.5) / count * whole;
    while (k + 1 < kArcSteps && length[static_cast<std::size_t>(k + 1)] < at) ++k;
    const double from = length[static_cast<std::size_t>(k)], to = length[static_cast<std::size_t>(k + 1)];
    result.push_back(site(arc_begin_ + piece * (k + (at - from) / (to - from))));
    result.back().slot = i * (kSlots / count) + kSlots / count / 2;
  }
}

void Ellipse::move(const Eigen::VectorXd& step) {
  displace(step);
}

void Ellipse::displace(const Eigen::Matrix<double, 5, 1>& step) {
  centre_ += step.head<2>();
  shape_(0, 0) += step[2];
  shape_(1, 1) += step[3];
  shape_(0, 1) += step[4];
  shape_(1, 0) = shape_(0, 1);
}

// A conic C goes to G^-T C G^-1.
void Ellipse::transform(const Eigen::Matrix3d& motion) {
  const Eigen::Matrix2d e = (shape_ * shape_).inverse();
  Eigen::Matrix3d m;
  m << e, -e * centre_, -(e * centre_).transpose(), centre_.dot(e * centre_) - 1.0;
  const Eigen::Matrix3d back = motion.inverse();
  if (!split(back.transpose() * m * back, centre_, shape_)) shape_.setConstant(std::nan(""));
}

// The centre may be anywhere in the range; the shape is where it was expected, as well as it was known.
void Ellipse::known(const Curve& expected, double range, Eigen::MatrixXd& information, Eigen::VectorXd& mean) const {
  information.setIdentity(5, 5);
  information /= range * range;
  mean.setZero(5);
  const Eigen::Matrix2d difference = static_cast<const Ellipse&>(expected).shape_ - shape_;
  mean.tail<3>() << difference(0, 0), difference(1, 1), difference(0, 1);
  information.bottomRightCorner<3, 3>() += shape_information_;
}

void Ellipse::settle(const std::vector<SiteFinding>&, const Eigen::MatrixXd& covariance, double passed) {
  // Of the radii, by a scope that moves in or out: 17 % in a second, as a random walk from image to image.
  const double change = kChange * 0.5 * shape_.trace();
  Eigen::Matrix3d variance = covariance.bottomRightCorner<3, 3>();
  variance.diagonal().array() += kLeastChange * kLeastChange + change * change * std::max(0.0, passed) / kChangeTime;
  shape_information_ = variance.inverse();
}

bool Ellipse::isSound() const {
  if (!centre_.allFinite() || !shape_.allFinite()) return false;
  const Eigen2d axes = decomposed(shape_);
  return axes.eigenvalues()[0] >= kMinRadius && axes.eigenvalues()[1] < 1e5;
}

double Ellipse::change(const Curve& before) const {
  // The factors by which the unit circle of one is stretched in the frame of the other.
  const Eigen::Matrix2d s = static_cast<const Ellipse&>(before).shape_.inverse() * shape_;
  const Eigen2d stretch = decomposed(s.transpose() * s);
  const double most = std::sqrt(stretch.eigenvalues()[1]), least = std::sqrt(std::max(1e-12, stretch.eigenvalues()[0]));
  return std::max({most, 1.0 / least, 1.0});
}

}  // namespace laparoscope_servo::features
