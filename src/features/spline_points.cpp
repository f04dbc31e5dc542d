// How a spline is made: from control points, or through points.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "laparoscope_servo/features/spline.h"

namespace laparoscope_servo::features {

namespace {

constexpr double kPiece = 16.0;   // px, from control point to control point, unless their number is given;
constexpr int kMostUnasked = 32;  // but no more of them than this, or than points are given
constexpr double kApart = 2.0;    // px, from point to point, at least
constexpr int kChords = 16;       // between two of the given points
constexpr int kSweeps = 24;       // each leaves a quarter of the error

[[noreturn]] void refuse(const std::string& what, double value, const std::string& expected) {
  std::ostringstream text;
  text << "spline: " << what << " = " << value << ", expected " << expected;
  throw std::invalid_argument(text.str());
}

void check(const std::vector<Eigen::Vector2d>& points, bool closed, std::size_t least, std::size_t most) {
  if (points.size() < least || points.size() > most) {
    refuse("number of points", static_cast<double>(points.size()),
           std::to_string(least) + " to " + std::to_string(most));
  }
  for (const Eigen::Vector2d& point : points) {
    for (const double value : {point.x(), point.y()}) {
      if (!(std::abs(value) < kFarthest)) refuse("coordinate of a point", value, "a number below 100000 px");
    }
  }
  for (std::size_t k = 0; k + (closed ? 0 : 1) < points.size(); ++k) {
    const double apart = (points[(k + 1) % points.size()] - points[k]).norm();
    if (!(apart >= kApart)) refuse("distance of two neighbouring points", apart, "at least 2 px");
  }
}

// Catmull-Rom's curve from b to c, with parameters by the roots of the chords, which make no loops.
Eigen::Vector2d between(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                        const Eigen::Vector2d& d, double u) {
  const double s = std::sqrt((b - a).norm()), m = std::sqrt((c - b).norm()), e = std::sqrt((d - c).norm());
  const Eigen::Vector2d chord = c - b;
  const Eigen::Vector2d begin = s > 0.0 ? Eigen::Vector2d(m * ((b - a) / s - (c - a) / (s + m)) + chord) : chord;
  const Eigen::Vector2d end = e > 0.0 ? Eigen::Vector2d(m * ((d - c) / e - (d - b) / (m + e)) + chord) : chord;
  const double v = u * u;
  return (2.0 * v * u - 3.0 * v + 1.0) * b + (v * u - 2.0 * v + u) * begin + (-2.0 * v * u + 3.0 * v) * c +
         (v * u - v) * end;
}

std::vector<Eigen::Vector2d> denseCurve(const std::vector<Eigen::Vector2d>& points, bool closed) {
  const int count = static_cast<int>(points.size());
  const auto point = [&](int k) -> const Eigen::Vector2d& {
    return points[static_cast<std::size_t>(closed ? (k + count) % count : std::clamp(k, 0, count - 1))];
  };
  std::vector<Eigen::Vector2d> result;
  for (int k = 0; k < (closed ? count : count - 1); ++k) {
    for (int i = 0; i < kChords; ++i) {
      result.push_back(between(point(k - 1), point(k), point(k + 1), point(k + 2), static_cast<double>(i) / kChords));
    }
  }
  result.push_back(closed ? points.front() : points.back());
  return result;
}

}  // namespace

Spline::Spline(const std::vector<Eigen::Vector2d>& control_points, bool closed) : closed_(closed) {
  check(control_points, closed, kLeastPoints, kMostPoints);
  size_ = static_cast<int>(control_points.size());
  std::copy(control_points.begin(), control_points.end(), points_.begin());
  if (!(length() >= kMinLength)) refuse("length", length(), "at least 40 px");
  if (!isSound()) throw std::invalid_argument("spline: the control points turn back on themselves, expected a curve");
}

Spline Spline::throughPoints(const std::vector<Eigen::Vector2d>& points, bool closed, int control_points) {
  check(points, closed, closed ? 4 : 3, 1000);
  if (control_points != 0 && (control_points < kLeastPoints || control_points > kMostPoints)) {
    refuse("control points", control_points, "6 to 48, or 0");
  }
  const std::vector<Eigen::Vector2d> dense = denseCurve(points, closed);
  std::vector<double> length(1, 0.0);
  for (std::size_t k = 1; k < dense.size(); ++k) length.push_back(length.back() + (dense[k] - dense[k - 1]).norm());
  if (!(length.back() >= kMinLength)) refuse("length", length.back(), "at least 40 px");
  Spline result;
  result.closed_ = closed;
  const int ends = closed ? 0 : 3, given = static_cast<int>(points.size()) + (closed ? 0 : 2);
  const int by_length = std::min(static_cast<int>(length.back() / kPiece) + ends, kMostUnasked);
  result.size_ =
      control_points != 0 ? control_points : std::clamp(std::max(by_length, given), kLeastPoints, kMostPoints);
  const int nodes = closed ? result.size_ : result.size_ - 2;
  Points node;
  std::size_t k = 0;
  for (int i = 0; i < nodes; ++i) {
    const double distance = length.back() * i / result.pieces();
    while (k + 2 < dense.size() && length[k + 1] < distance) ++k;
    const double part = std::clamp((distance - length[k]) / (length[k + 1] - length[k]), 0.0, 1.0);
    node[static_cast<std::size_t>(i)] = dense[k] + part * (dense[k + 1] - dense[k]);
  }
  result.interpolate(node);
  if (!result.isSound()) throw std::invalid_argument("spline: the points turn back on themselves, expected a curve");
  return result;
}

// A knot lies at a sixth of its neighbours' control points and four of its own, solved by Gauss-Seidel sweeps. An open
// curve is straight at its ends.
void Spline::interpolate(const Points& nodes) {
  const int shift = closed_ ? 0 : 1, last = closed_ ? size_ - 1 : size_ - 2;
  const auto node = [&](int k) -> const Eigen::Vector2d& { return nodes[static_cast<std::size_t>(k - shift)]; };
  for (int k = shift; k <= last; ++k) points_[static_cast<std::size_t>(k)] = node(k);
  const int first_inner = closed_ ? 0 : 2, last_inner = closed_ ? size_ - 1 : size_ - 3;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int k = first_inner; k <= last_inner; ++k) {
      points_[static_cast<std::size_t>(k)] =
          1.5 * node(k) - 0.25 * (controlPoint(wrapped(k - 1)) + controlPoint(wrapped(k + 1)));
    }
  }
  if (closed_) return;
  points_[0] = 2.0 * controlPoint(1) - controlPoint(2);
  points_[static_cast<std::size_t>(size_ - 1)] = 2.0 * controlPoint(size_ - 2) - controlPoint(size_ - 3);
}

}  // namespace laparoscope_servo::features
