#include "features/spline_prior.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace laparoscope_servo::features {

Spline::Matrix stiffness(int size, bool closed, const Deformation& deformation) {
  Spline::Matrix result = Spline::Matrix::Identity(size, size) / (deformation.whole * deformation.whole);
  const double bending = 1.0 / (deformation.bend * deformation.bend);
  constexpr double kDifference[] = {-0.5, 1.0, -0.5};
  for (int middle = closed ? 0 : 1; middle < (closed ? size : size - 1); ++middle) {
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 3; ++l) {
        const int row = (middle + k - 1 + size) % size, column = (middle + l - 1 + size) % size;
        result(row, column) += bending * kDifference[k] * kDifference[l];
      }
    }
  }
  return result;
}

Spline::Matrix freed(const Spline::Matrix& stiffness, const Modes& modes, double deviation) {
  const Modes pulled = stiffness.lazyProduct(modes);
  Eigen::Matrix4d inner = modes.transpose().lazyProduct(pulled);
  inner.diagonal().array() += 1.0 / (deviation * deviation);
  const Modes weighted = pulled.lazyProduct(Eigen::Matrix4d(inner.inverse()));
  Spline::Matrix result = stiffness;
  result.noalias() -= weighted.lazyProduct(pulled.transpose());
  return result;
}

Extent::Extent(const Spline::Points& points, int size) : centre(Eigen::Vector2d::Zero()) {
  for (int k = 0; k < size; ++k) centre += points[static_cast<std::size_t>(k)] / size;
  double squares = 0.0;
  for (int k = 0; k < size; ++k) squares += (points[static_cast<std::size_t>(k)] - centre).squaredNorm() / size;
  radius = std::max(1.0, std::sqrt(squares));
}

Similarity::Similarity(const Spline::Points& from, const Spline::Points& to, int size) {
  const Extent source(from, size), target(to, size);
  double along = 0.0, across = 0.0;
  for (int k = 0; k < size; ++k) {
    const Eigen::Vector2d a = from[static_cast<std::size_t>(k)] - source.centre;
    const Eigen::Vector2d b = to[static_cast<std::size_t>(k)] - target.centre;
    along += a.dot(b);
    across += a.x() * b.y() - a.y() * b.x();
  }
  const double size2 = size * source.radius * source.radius;
  linear << along / size2, -across / size2, across / size2, along / size2;
  translation = target.centre - linear * source.centre;
}

}  // namespace laparoscope_servo::features
