// Whether a fit may be believed: how many sites agree with the curve, by more than chance, and how well they fix it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "laparoscope_servo/features/curve.h"
#include "laparoscope_servo/features/edge_config.h"
#include "laparoscope_servo/features/edge_fit.h"

namespace laparoscope_servo::features {

struct FitOutcome {
  const std::vector<Site>& sites;
  const std::vector<SiteFinding>& findings;
  const Eigen::MatrixXd& covariance;  // of the curve's parameters
  int parameters;                     // of the curve
  bool deforms;                       // what is not seen of the curve is not known from the rest of it
  double range;                       // px either side that was searched
  double matching;                    // edges per site, within the range, that could be the curve's
};

// By what the covariance of a fit that takes sites for independent is too small: edges err alike over some length of
// the curve. `spacing`: px from site to site.
double correlation(double spacing);

// Fills in what the report lacks: its sigma is known. `min_share`: of the sites in the image, that agree.
void judge(const FitOutcome& fit, const EdgeConfig& config, double min_share, EdgeReport& report);

}  // namespace laparoscope_servo::features
