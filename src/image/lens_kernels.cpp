// The loops over rows of pixels, in single precision.
#include <cmath>
#include <limits>

#include "image/kernel_parts.h"
#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::image {

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

LAPAROSCOPE_SERVO_CLONES
void locatePolynomial(const LensLoop& lens, const ProjectiveRow& row, int first, int count, float* __restrict u,
                      float* __restrict v) {
  const LensLoop l = lens;
  const ProjectiveRow r = row;
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const auto [x, y, w] = pointOf(r, static_cast<float>(first + i));
    const float q = x * x + y * y;
    const float radial =
        (1.0f + q * (l.k[0] + q * (l.k[1] + q * l.k[2]))) / (1.0f + q * (l.k[3] + q * (l.k[4] + q * l.k[5])));
    const float xy = 2.0f * x * y;
    const float xd = x * radial + l.p1 * xy + l.p2 * (q + 2.0f * x * x);
    const float yd = y * radial + l.p1 * (q + 2.0f * y * y) + l.p2 * xy;
    const float limit = w > 0.0f ? l.field : 0.0f;  // q is never below 0
    const float ur = l.fx * xd + l.cx;
    const float vr = l.fy * yd + l.cy;
    u[i] = q < limit ? ur : kNone;
    v[i] = q < limit ? vr : kNone;
  }
}

// atan(t) / t as a polynomial in t^2, for t in [0, 1]: a minimax fit, off by less than 1e-7.
inline float atanOver(float s) {
  float a = 0.002903552493080497f;
  a = a * s - 0.016283007338643074f;
  a = a * s + 0.043039366602897644f;
  a = a * s - 0.0753367617726326f;
  a = a * s + 0.10654677450656891f;
  a = a * s - 0.14207133650779724f;
  a = a * s + 0.19993053376674652f;
  a = a * s - 0.3333309292793274f;
  return a * s + 1.0f;
}

LAPAROSCOPE_SERVO_CLONES
void locateEquidistant(const LensLoop& lens, const ProjectiveRow& row, int first, int count, float* __restrict u,
                       float* __restrict v) {
  const LensLoop l = lens;
  const ProjectiveRow r = row;
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const auto [x, y, w] = pointOf(r, static_cast<float>(first + i));
    const float q = x * x + y * y;
    // On the axis the ratio of angle to distance is 1; avoids 0 / 0.
    const float distance = std::sqrt(q > 1e-12f ? q : 1e-12f);
    const float per_distance = 1.0f / distance;
    const bool far = distance > 1.0f;
    const float s = far ? per_distance : distance;
    const float near_angle = s * atanOver(s * s);
    const float rest = 1.57079632679489662f - near_angle;
    const float angle = far ? rest : near_angle;
    const float a2 = angle * angle;
    const float factor = angle * per_distance * (1.0f + a2 * (l.k[0] + a2 * (l.k[1] + a2 * (l.k[2] + a2 * l.k[3]))));
    const float limit = w > 0.0f ? l.field : 0.0f;  // q is never below 0
    const float ur = l.fx * x * factor + l.cx;
    const float vr = l.fy * y * factor + l.cy;
    u[i] = q < limit ? ur : kNone;
    v[i] = q < limit ? vr : kNone;
  }
}

}  // namespace

void locateRaw(const LensLoop& lens, const ProjectiveRow& row, int first, int count, float* u, float* v) {
  lens.equidistant ? locateEquidistant(lens, row, first, count, u, v) : locatePolynomial(lens, row, first, count, u, v);
}

}  // namespace laparoscope_servo::image
