#include "tracking/contour_texture/block_agreement.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::tracking {

namespace {

constexpr int kSide = 12;           // px of the level: as few as tell a correlation of 0.6 from chance
constexpr double kLeastFull = 0.5;  // of a block's pixels, that have a weight
constexpr double kTexture = 2.0;    // times the noise

struct Sums {
  double w = 0.0, t = 0.0, i = 0.0, tt = 0.0, ii = 0.0, ti = 0.0;
};

}  // namespace

BlockAgreement blockAgreement(const EsmLevel& level, double noise, double min_correlation) {
  BlockAgreement result;
  const EsmPlane& plane = level.planes[0];
  const image::Patch& weight = level.usedWeight();
  for (int top = 0; top + kSide <= level.height; top += kSide) {
    for (int left = 0; left + kSide <= level.width; left += kSide) {
      Sums s;
      for (int y = top; y < top + kSide; ++y) {
        const float *w = weight.row(y), *t = plane.value.row(y), *i = plane.warped.row(y);
        for (int x = left; x < left + kSide; ++x) {
          const double wx = static_cast<double>(w[x]), tx = static_cast<double>(t[x]), ix = static_cast<double>(i[x]);
          s.w += wx;
          s.t += wx * tx;
          s.i += wx * ix;
          s.tt += wx * tx * tx;
          s.ii += wx * ix * ix;
          s.ti += wx * tx * ix;
        }
      }
      if (!(s.w >= kLeastFull * kSide * kSide)) continue;
      const double tt = s.tt / s.w - s.t * s.t / (s.w * s.w), ii = s.ii / s.w - s.i * s.i / (s.w * s.w);
      if (!(tt > kTexture * kTexture * noise * noise)) continue;
      ++result.blocks;
      const double ti = s.ti / s.w - s.t * s.i / (s.w * s.w);
      if (ti > min_correlation * std::sqrt(tt * std::max(ii, 1e-6))) ++result.correlate;
    }
  }
  return result;
}

}  // namespace laparoscope_servo::tracking
