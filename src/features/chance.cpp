#include "features/chance.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::features {

namespace {

constexpr double kFalseAlarms = 1e-4;  // expected number, per image
constexpr int kMostFreedoms = 4;       // a curve's other freedoms are held by what is known of its shape

double part(double share, double chance) {
  return share > 0.0 ? share * std::log(share / chance) : 0.0;
}

}  // namespace

double evidence(const Agreement& a) {
  if (a.sites <= 0) return 0.0;
  const double share = static_cast<double>(a.agree) / a.sites;
  // A stray edge lies within the tolerance of a given curve.
  const double chance = std::clamp(a.strays * a.tolerance / a.range, 1e-3, 0.999);
  if (!(share > chance)) return 0.0;
  // Hoeffding: of n sites at least share n agree with a probability of at most exp(-n D), D the divergence of the two.
  return a.independent * a.sites * (part(share, chance) + part(1.0 - share, 1.0 - chance));
}

bool isNoChance(const Agreement& a) {
  const double curves = std::min(a.freedoms, kMostFreedoms) * std::log(a.range / a.tolerance);
  return evidence(a) > curves - std::log(kFalseAlarms);
}

}  // namespace laparoscope_servo::features
