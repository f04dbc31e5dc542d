#include "laparoscope_servo/features/spline.h"

#include <algorithm>
#include <cmath>

#include "features/spline_prior.h"
#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/robust/largest.h"

namespace laparoscope_servo::features {

namespace {

// A contour deforms by a share of its lengths, from one image to the next, and by what its edges show besides.
constexpr double kChange = 0.005;     // standard deviation, within kChangeTime
constexpr double kChangeTime = 0.04;  // s
constexpr double kLeastChange = 0.2;  // px
constexpr double kAnywhere = 50.0;    // px: of the similarity, which the coarse stage finds
constexpr double kLeastPiece = 2.0;   // px, between control points
constexpr double kLargest = 1e5;      // px
constexpr double kUneven = 1.5;       // ratio of the longest piece to the shortest one, beyond which they are laid anew

// Marchand and Chaumette (2004), II.B.3: a sum of control points, weighted by the basis of cubic B-splines. Of the four
// of a piece, at u in [0, 1]: values, and first and second derivatives by u.
struct Basis {
  explicit constexpr Basis(double u)
      : value{(1.0 - u) * (1.0 - u) * (1.0 - u) / 6.0, (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0,
              (-3.0 * u * u * u + 3.0 * u * u + 3.0 * u + 1.0) / 6.0, u * u * u / 6.0},
        slope{-0.5 * (1.0 - u) * (1.0 - u), 1.5 * u * u - 2.0 * u, -1.5 * u * u + u + 0.5, 0.5 * u * u},
        bend{1.0 - u, 3.0 * u - 2.0, -3.0 * u + 1.0, u} {}
  std::array<double, 4> value, slope, bend;
};

Eigen::Vector2d across(const Eigen::Vector2d& tangent) {
  return Eigen::Vector2d(tangent.y(), -tangent.x()).normalized();
}

}  // namespace

Eigen::Vector2d Spline::at(double t) const {
  const int piece = std::clamp(static_cast<int>(t), 0, pieces() - 1), first = firstOf(piece);
  const Basis basis(t - piece);
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  for (int k = 0; k < 4; ++k) point += basis.value[static_cast<std::size_t>(k)] * controlPoint(wrapped(first + k));
  return point;
}

// Of the curve next to the control point: along the chord of its neighbours.
Eigen::Vector2d Spline::normal(int k) const {
  const int before = closed_ ? wrapped(k - 1) : std::max(k - 1, 0);
  const int after = closed_ ? wrapped(k + 1) : std::min(k + 1, size_ - 1);
  return across(controlPoint(after) - controlPoint(before));
}

// A control point that moves along its own normal moves the curve's point by as much as the basis says, of which the
// part along the normal there is seen.
Site Spline::site(double t, const Points& normals) const {
  const int piece = std::clamp(static_cast<int>(t), 0, pieces() - 1), first = firstOf(piece);
  const Basis basis(t - piece);
  Site site;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero(), bend = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector2d& p = controlPoint(wrapped(first + static_cast<int>(k)));
    site.point += basis.value[k] * p;
    slope += basis.slope[k] * p;
    bend += basis.bend[k] * p;
  }
  const double speed = slope.norm();
  site.normal = across(slope);
  site.curvature = (slope.x() * bend.y() - slope.y() * bend.x()) / (speed * speed * speed);
  site.first = first;
  site.count = 4;
  for (std::size_t k = 0; k < 4; ++k) {
    site.jacobian[k] =
        basis.value[k] * site.normal.dot(normals[static_cast<std::size_t>(wrapped(first + static_cast<int>(k)))]);
  }
  return site;
}

// Up to each step, by chords.
void Spline::lengths(Lengths& table) const {
  constexpr std::array<Basis, kSteps> kAt = {Basis(0.25), Basis(0.5), Basis(0.75), Basis(1.0)};
  Eigen::Vector2d before = at(0.0);
  std::size_t k = 0;
  table[0] = 0.0;
  for (int piece = 0; piece < pieces(); ++piece) {
    const int first = firstOf(piece);
    const Eigen::Vector2d &a = controlPoint(first), &b = controlPoint(wrapped(first + 1)),
                          &c = controlPoint(wrapped(first + 2)), &d = controlPoint(wrapped(first + 3));
    for (const Basis& basis : kAt) {
      const Eigen::Vector2d here = basis.value[0] * a + basis.value[1] * b + basis.value[2] * c + basis.value[3] * d;
      table[k + 1] = table[k] + (here - before).norm();
      before = here;
      ++k;
    }
  }
}

double Spline::length() const {
  Lengths table;
  lengths(table);
  return table[static_cast<std::size_t>(pieces() * kSteps)];
}

void Spline::sites(double spacing, int most, std::vector<Site>& result) const {
  result.clear();
  Lengths table;
  lengths(table);
  const int steps = pieces() * kSteps;
  const double whole = table[static_cast<std::size_t>(steps)];
  int count = kSlots;
  while (count > 16 && (count > most || whole / count < 0.7 * spacing)) count /= 2;
  Points normals;
  for (int i = 0; i < size_; ++i) normals[static_cast<std::size_t>(i)] = normal(i);
  int k = 0;
  for (int i = 0; i < count; ++i) {
    const double distance = (i + 0.5) / count * whole;
    while (k + 1 < steps && table[static_cast<std::size_t>(k + 1)] < distance) ++k;
    const double from = table[static_cast<std::size_t>(k)], to = table[static_cast<std::size_t>(k + 1)];
    result.push_back(site((k + (distance - from) / (to - from)) / kSteps, normals));
    result.back().slot = i * (kSlots / count) + kSlots / count / 2;
  }
}

void Spline::move(const Eigen::VectorXd& step) {
  Points moved = points_;
  for (int k = 0; k < size_; ++k) moved[static_cast<std::size_t>(k)] += step[k] * normal(k);
  points_ = moved;
}

void Spline::spread(const Eigen::MatrixXd& of_parameters, Eigen::MatrixXd& result) const {
  result.resize(2 * size_, 2 * size_);
  for (int k = 0; k < size_; ++k) {
    for (int l = 0; l < size_; ++l) {
      result.block<2, 2>(2 * k, 2 * l) = of_parameters(k, l) * normal(k) * normal(l).transpose();
    }
  }
}

void Spline::transform(const Eigen::Matrix3d& motion) {
  for (int k = 0; k < size_; ++k) {
    Eigen::Vector2d& point = points_[static_cast<std::size_t>(k)];
    point = geometry::apply(motion, point);
  }
}

void Spline::known(const Curve& expected, double range, Eigen::MatrixXd& information, Eigen::VectorXd& mean) const {
  const Points& there = static_cast<const Spline&>(expected).points_;
  const Similarity similarity(there, points_, size_);
  mean.resize(size_);
  for (int k = 0; k < size_; ++k) {
    mean[k] = normal(k).dot(similarity(there[static_cast<std::size_t>(k)]) - controlPoint(k));
  }
  // Points that a person has given lie anywhere in the range, one by one.
  if (information_.size() > 0) {
    information = information_;
  } else {
    information = stiffness(size_, closed_, {0.5 * range, range});
  }
}

// Of what is covered, where it was expected is not forgotten with time: it would follow stray edges.
void Spline::settle(const std::vector<SiteFinding>&, const Eigen::MatrixXd&, double passed) {
  const Extent extent(points_, size_);
  const double change = kChange * std::sqrt((passed > 0.0 ? passed : kChangeTime) / kChangeTime);
  deformation_ = kLeastChange + change * extent.radius;
  Modes similarity(size_, 4);
  for (int k = 0; k < size_; ++k) {
    const Eigen::Vector2d arm = (controlPoint(k) - extent.centre) / extent.radius, n = normal(k);
    similarity.row(k) << n.x(), n.y(), n.dot(arm), n.y() * arm.x() - n.x() * arm.y();
  }
  const Deformation deformation = {kLeastChange + change * length() / pieces(), deformation_};
  information_ = freed(stiffness(size_, closed_, deformation), similarity, kAnywhere);
  spaceEvenly();
}

// Control points move across the curve only, and gather where it is hollow.
void Spline::spaceEvenly() {
  Lengths table;
  lengths(table);
  double shortest = kLargest, longest = 0.0;
  for (int k = 0; k < pieces(); ++k) {
    const double piece =
        table[static_cast<std::size_t>((k + 1) * kSteps)] - table[static_cast<std::size_t>(k * kSteps)];
    shortest = std::min(shortest, piece);
    longest = std::max(longest, piece);
  }
  if (!(longest > kUneven * shortest)) return;
  const int steps = pieces() * kSteps, nodes = closed_ ? size_ : size_ - 2;
  Points node;
  int k = 0;
  for (int i = 0; i < nodes; ++i) {
    const double distance = table[static_cast<std::size_t>(steps)] * i / pieces();
    while (k + 1 < steps && table[static_cast<std::size_t>(k + 1)] < distance) ++k;
    const double from = table[static_cast<std::size_t>(k)], to = table[static_cast<std::size_t>(k + 1)];
    node[static_cast<std::size_t>(i)] = at((k + (distance - from) / (to - from)) / kSteps);
  }
  interpolate(node);
}

bool Spline::isSound() const {
  if (size_ < kLeastPoints) return false;
  for (int k = 0; k < size_; ++k) {
    const Eigen::Vector2d& p = controlPoint(k);
    if (!(p.allFinite() && p.norm() < kLargest)) return false;
    if (!closed_ && k + 2 >= size_) continue;
    const Eigen::Vector2d a = controlPoint(wrapped(k + 1)) - p,
                          b = controlPoint(wrapped(k + 2)) - controlPoint(wrapped(k + 1));
    // It does not turn back on itself.
    if (!(a.norm() >= kLeastPiece && b.norm() >= kLeastPiece && a.dot(b) > -0.5 * a.norm() * b.norm())) return false;
  }
  return true;
}

double Spline::change(const Curve& before) const {
  const Points& there = static_cast<const Spline&>(before).points_;
  const Similarity similarity(there, points_, size_);
  const Extent extent(points_, size_);
  double deviation = 0.0;
  for (int k = 0; k < size_; ++k) {
    const Eigen::Vector2d difference = similarity(there[static_cast<std::size_t>(k)]) - controlPoint(k);
    deviation = robust::largest(deviation, std::abs(normal(k).dot(difference)));
  }
  return std::max({similarity.scale(), 1.0 / similarity.scale(), 1.0 + deviation / extent.radius});
}

}  // namespace laparoscope_servo::features
