// A closed contour that deforms from image to image, whose place is known: a circle with three waves on it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "laparoscope_servo/features/spline.h"
#include "support/synthetic_edges.h"

namespace laparoscope_servo::test {

struct Contour {
  // Image `k` of a sequence. `size`: px, mean radius; `deformation`: 1 moves the waves' crests by up to 1.3 % of the
  // radius from image to image.
  Contour(int k, const Eigen::Vector2d& middle, double size, double deformation = 1.0)
      : centre(middle + Eigen::Vector2d(8.0 * std::sin(k / 5.0), 6.0 * std::cos(k / 7.0))),
        radius(size * (1.0 + 0.05 * std::sin(k / 8.0))),
        waves{0.10 + 0.05 * deformation * std::sin(k / 6.0), 0.06 * deformation * std::sin(k / 9.0) + 0.03,
              0.04 * deformation * std::cos(k / 7.0)} {}

  double at(double angle) const {
    return radius * (1.0 + waves[0] * std::cos(2.0 * angle + 0.3) + waves[1] * std::cos(3.0 * angle + 1.0) +
                     waves[2] * std::cos(5.0 * angle));
  }
  Region region() const {
    return [*this](const Eigen::Vector2d& p) {
      const Eigen::Vector2d d = p - centre;
      return d.norm() < at(std::atan2(d.y(), d.x()));
    };
  }
  Eigen::Vector2d point(double angle) const {
    return centre + at(angle) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  std::vector<Eigen::Vector2d> points(int count) const {
    std::vector<Eigen::Vector2d> result;
    for (int i = 0; i < count; ++i) result.push_back(point(2.0 * M_PI * i / count));
    return result;
  }
  // px, of a point that lies near it, positive outside.
  double distance(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d d = p - centre;
    const double angle = std::atan2(d.y(), d.x());
    const double slope = (at(angle + 1e-4) - at(angle - 1e-4)) / 2e-4 / at(angle);
    return (d.norm() - at(angle)) / std::hypot(1.0, slope);
  }
  // Distances of the curve from the contour, px, all along it.
  std::vector<double> errors(const features::Spline& curve) const {
    std::vector<double> result;
    for (int i = 0; i < 100; ++i) result.push_back(std::abs(distance(curve.at(curve.pieces() * i / 100.0))));
    return result;
  }

  Eigen::Vector2d centre;
  double radius;
  std::array<double, 3> waves;
};

}  // namespace laparoscope_servo::test
