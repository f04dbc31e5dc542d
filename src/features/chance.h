// Whether sites agree with a curve by more than chance.
#pragma once

namespace laparoscope_servo::features {

struct Agreement {
  int sites = 0;             // looked at
  int agree = 0;             // have an edge within `tolerance` of the curve
  double tolerance = 1.0;    // px
  double strays = 0.0;       // edges per site that do not belong to the curve but could, over the whole range
  double range = 20.0;       // px, either side
  int freedoms = 2;          // of the curve
  double independent = 1.0;  // share of the sites that do not see what their neighbours see
};

// How improbable it is that, were the edges strewn at random, so many agree with one given curve: minus the logarithm
// of a bound of the probability, at least 0.
double evidence(const Agreement& agreement);

// True when, were the edges strewn at random, fewer than one image in 10,000 would have as good a curve anywhere in the
// range.
bool isNoChance(const Agreement& agreement);

}  // namespace laparoscope_servo::features
