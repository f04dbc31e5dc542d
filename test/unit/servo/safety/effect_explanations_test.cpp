#include "servo/safety/effect_explanations.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

namespace laparoscope_servo::servo {
namespace {

TEST(EffectExplanations, PicturesAreTurnedOrMirroredAndArmsOnlyReversedOrStill) {
  for (const EffectExplanation& e : effectExplanations()) {
    EXPECT_LT((e.picture.transpose() * e.picture - Eigen::Matrix2d::Identity()).norm(), 1e-12) << e.fault;
    for (const double sign : {e.arm[0], e.arm[1], e.arm[2], e.arm[3]}) {
      EXPECT_TRUE(std::abs(sign) == 1.0 || e.frozen()) << e.fault;
    }
    EXPECT_GT(e.reach, 0.0);
  }
}

TEST(EffectExplanations, AFaultDiffersFromWhatIsRightByMoreThanErrorsOfDepthAndDelay) {
  int good = 0;
  for (const EffectExplanation& e : effectExplanations()) {
    const bool as_it_should = e.picture.isIdentity() && e.arm == Eigen::Vector4d::Ones();
    if (e.fault.empty()) {
      ++good;
      EXPECT_TRUE(as_it_should);
      EXPECT_LT(e.late, 0.15);
    } else {
      EXPECT_TRUE(!as_it_should || e.late >= 0.3) << e.fault;
      EXPECT_EQ(e.reach, 1.0) << e.fault;
    }
  }
  EXPECT_GT(good, 0);
}

TEST(EffectExplanations, NoTwoAreAlike) {
  const std::vector<EffectExplanation> all = effectExplanations();
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_FALSE(all[i].picture.isApprox(all[k].picture, 1e-9) && all[i].arm == all[k].arm &&
                   all[i].late == all[k].late && all[i].reach == all[k].reach)
          << all[i].fault << " and " << all[k].fault;
    }
  }
}

// A camera may be turned by any angle: one that is turned so far that the loop would not converge moves the picture
// nearly as one of the explanations says, whichever way the scope moves.
TEST(EffectExplanations, EveryRollThatLeadsAstrayAndEveryMirrorIsNearOne) {
  const std::vector<EffectExplanation> all = effectExplanations();
  for (int degrees = 60; degrees <= 300; degrees += 5) {
    for (const bool mirrored : {false, true}) {
      Eigen::Matrix2d seen = Eigen::Rotation2Dd(degrees * M_PI / 180.0).toRotationMatrix();
      if (mirrored) seen *= Eigen::Vector2d(-1.0, 1.0).asDiagonal();
      double best = -1.0;
      for (const EffectExplanation& e : all) {
        if (e.fault.empty() || e.arm != Eigen::Vector4d::Ones()) continue;
        best = std::max(best, 0.5 * (seen.transpose() * e.picture).trace());  // the cosine between both motions
      }
      EXPECT_GT(best, std::cos(15.5 * M_PI / 180.0)) << degrees << (mirrored ? " mirrored" : "");
    }
  }
}

TEST(EffectExplanations, EachAxisOfTheArmCanBeReversedAlone) {
  std::set<int> reversed;
  for (const EffectExplanation& e : effectExplanations()) {
    for (int k = 0; k < 4; ++k) {
      Eigen::Vector4d one = Eigen::Vector4d::Ones();
      one[k] = -1.0;
      if (e.arm == one) reversed.insert(k);
    }
  }
  EXPECT_EQ(reversed.size(), 4u);
}

}  // namespace
}  // namespace laparoscope_servo::servo
