// What holds for every curve, by differences.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "laparoscope_servo/features/curve.h"

namespace laparoscope_servo::features {

// The jacobian of each site against where a moved copy of the curve lies. `distance(curve, point, normal)`: how far the
// curve is from the point along the normal.
template <class C, class Distance>
void expectJacobiansHold(const C& curve, const Distance& distance) {
  constexpr double kStep = 1e-3;
  std::vector<Site> sites;
  curve.sites(4.0, 200, sites);
  ASSERT_GT(sites.size(), 7u);
  for (int p = 0; p < curve.parameters(); ++p) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(curve.parameters());
    C more = curve, less = curve;
    step[p] = kStep;
    more.move(step);
    less.move(-step);
    for (const Site& site : sites) {
      double expected = 0.0;
      for (int k = 0; k < site.count; ++k) {
        if ((site.first + k) % curve.parameters() == p) expected += site.jacobian[static_cast<std::size_t>(k)];
      }
      const double moved =
          (distance(more, site.point, site.normal) - distance(less, site.point, site.normal)) / (2.0 * kStep);
      EXPECT_NEAR(moved, expected, 2e-3) << "parameter " << p << ", slot " << site.slot;
    }
  }
}

// Sites lie on the curve, normals are across it and of length 1, slots are in range and grow.
inline void expectSitesAreInOrder(const Curve& curve, double spacing) {
  std::vector<Site> sites, coarse;
  curve.sites(spacing, 500, sites);
  curve.sites(spacing, 20, coarse);
  int before = -1;
  for (const Site& site : sites) {
    EXPECT_NEAR(site.normal.norm(), 1.0, 1e-9);
    EXPECT_GT(site.slot, before);
    EXPECT_LT(site.slot, curve.slots());
    before = site.slot;
  }
  int counted = 0;
  for (const Site& site : coarse) counted += site.probe ? 0 : 1;
  EXPECT_LE(counted, 20);
  EXPECT_GE(counted, 8);
}

}  // namespace laparoscope_servo::features
