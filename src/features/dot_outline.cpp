#include "features/dot_outline.h"

#include <cmath>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::features {

namespace {

// Of pixels (u + k, v) from the centre; uu, uv, vv: of M.
LAPAROSCOPE_SERVO_CLONES
void rowOf(float uu, float uv, float vv, float minor, float u, float v, int count, float* __restrict result) {
#pragma omp simd
  for (int k = 0; k < count; ++k) {
    const float du = u + static_cast<float>(k);
    const float mu = uu * du + uv * v, mv = uv * du + vv * v;
    const float square = du * mu + v * mv, length = std::sqrt(mu * mu + mv * mv);
    result[k] = length > 1e-9f ? (square - std::sqrt(square)) / length : -minor;
  }
}

}  // namespace

DotOutline::DotOutline(const Eigen::Matrix2d& m, double minor)
    : uu_(static_cast<float>(m(0, 0))),
      uv_(static_cast<float>(m(0, 1))),
      vv_(static_cast<float>(m(1, 1))),
      minor_(static_cast<float>(minor)) {}

void DotOutline::distances(const cv::Point& first, const Eigen::Vector2d& centre, int count, float* result) const {
  rowOf(uu_, uv_, vv_, minor_, static_cast<float>(first.x - centre.x()), static_cast<float>(first.y - centre.y()),
        count, result);
}

int sectorOf(double u, double v) {
  static_assert(kSectors == 12);
  constexpr double kTan30 = 0.5773502691896258, kTan60 = 1.7320508075688772;
  const int quadrant = v < 0.0 ? (u < 0.0 ? 0 : 1) : (u < 0.0 ? 3 : 2);
  // Along and across the axis at which the quadrant begins.
  const double x = quadrant % 2 == 0 ? std::abs(u) : std::abs(v), y = quadrant % 2 == 0 ? std::abs(v) : std::abs(u);
  return 3 * quadrant + (y > kTan30 * x ? 1 : 0) + (y > kTan60 * x ? 1 : 0);
}

}  // namespace laparoscope_servo::features
