#include "servo/safety/effect_budget.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "servo/safety/effect_explanations.h"

namespace laparoscope_servo::servo {
namespace {

constexpr double kDt = 0.04;  // s

class Seen {
 public:
  // An image that speaks against the faults that `against` names, by `ratio`.
  void see(const std::function<bool(const EffectExplanation&)>& against, double ratio = 5.0, double dt = kDt,
           const Eigen::Vector4d& pending = Eigen::Vector4d::Zero()) {
    std::vector<double> likelihoods;
    for (const EffectExplanation& e : effectExplanations()) {
      likelihoods.push_back(!e.fault.empty() && against(e) ? -ratio : 0.0);
    }
    budget.see(dt, likelihoods, pending, turned, breath_known);
  }

  EffectConfig config;
  EffectBudget budget{config};
  double turned = 0.0;  // rad
  bool breath_known = false;
};

bool all(const EffectExplanation&) {
  return true;
}
bool none(const EffectExplanation&) {
  return false;
}

TEST(EffectBudget, MotionIsSpentUntilTheImagesSpeakAgainstEveryFault) {
  Seen seen;
  seen.see(none);
  EXPECT_EQ(seen.budget.spent(), 0.0);
  seen.budget.command({0.5 * seen.config.unconfirmed_turn, 0.0, 0.0, 0.0}, true);
  EXPECT_NEAR(seen.budget.spent(), 0.5, 1e-9);
  seen.budget.command({0.0, 0.0, 0.0, -0.8 * seen.config.unconfirmed_insertion}, true);
  EXPECT_NEAR(seen.budget.spent(), 0.8, 1e-9);
  seen.see(all);
  EXPECT_EQ(seen.budget.spent(), 0.0);
  seen.budget.command({0.5, 0.0, 0.0, 0.1}, true);
  EXPECT_EQ(seen.budget.spent(), 0.0) << "nothing is open";
}

TEST(EffectBudget, AFaultIsSpentByTheMotionThatGoesWrongUnderIt) {
  const Eigen::Vector4d pan(0.02, 0.0, 0.0, 0.0), tilt(0.0, 0.02, 0.0, 0.0), spin(0.0, 0.0, 0.02, 0.0);
  const auto spentBy = [](const std::string& fault, const Eigen::Vector4d& motion) {
    Seen seen;
    seen.see([&](const EffectExplanation& e) { return e.fault != fault; });
    seen.budget.command(motion, true);
    return seen.budget.spent() * seen.config.unconfirmed_turn;
  };
  EXPECT_NEAR(spentBy("rolled by 90 degrees", pan), 0.02, 1e-9);
  EXPECT_NEAR(spentBy("rolled by 90 degrees", tilt), 0.02, 1e-9);
  EXPECT_NEAR(spentBy("rolled by 90 degrees", spin), 0.0, 1e-9);
  EXPECT_NEAR(spentBy("mirrored, left for right", pan), 0.02, 1e-9);
  EXPECT_NEAR(spentBy("mirrored, left for right", tilt), 0.0, 1e-9);
  EXPECT_NEAR(spentBy("mirrored, up for down", pan), 0.0, 1e-9);
  EXPECT_NEAR(spentBy("mirrored, up for down", tilt), 0.02, 1e-9);
  EXPECT_NEAR(spentBy("frozen, or another camera's", tilt), 0.02, 1e-9);
  EXPECT_NEAR(spentBy("frozen, or another camera's", spin), 0.02, 1e-9);
}

TEST(EffectBudget, AnAxisThatIsReversedIsSpentByItsOwnMotion) {
  const std::vector<std::string> axes{"pan", "tilt", "spin", "insertion"};
  for (int axis = 0; axis < 4; ++axis) {
    Seen seen;
    const double most = axis == 3 ? seen.config.unconfirmed_insertion : seen.config.unconfirmed_turn;
    const std::string fault = "moved by an arm whose " + axes[static_cast<std::size_t>(axis)] + " is reversed";
    seen.see([&](const EffectExplanation& e) { return e.fault != fault; });
    Eigen::Vector4d others = Eigen::Vector4d::Constant(0.02);
    others[axis] = 0.0;
    seen.budget.command(others, true);
    EXPECT_NEAR(seen.budget.spent(), 0.0, 1e-9) << fault;
    seen.budget.command(0.7 * most * Eigen::Vector4d::Unit(axis), true);
    EXPECT_NEAR(seen.budget.spent(), 0.7, 1e-9) << fault;
    EXPECT_NEAR(seen.budget.aside(), 0.0, 1e-9) << "its own motion shows it";
  }
}

// The share that goes wrong does not depend on which way the camera is turned about the shaft; which motion it is,
// does.
TEST(EffectBudget, AMirrorTurnsWithTheCamera) {
  Seen seen;
  seen.turned = 0.5 * M_PI;
  seen.see([](const EffectExplanation& e) { return e.fault != "mirrored, left for right"; });
  seen.budget.command({0.03, 0.0, 0.0, 0.0}, true);
  EXPECT_NEAR(seen.budget.spent(), 0.0, 1e-9);
  seen.budget.command({0.0, 0.03, 0.0, 0.0}, true);
  EXPECT_NEAR(seen.budget.spent(), 0.03 / seen.config.unconfirmed_turn, 1e-9);
}

TEST(EffectBudget, AnInterruptionOpensEveryFaultAndForgivesNothing) {
  Seen seen;
  seen.see(none);
  seen.budget.command({0.03, 0.0, 0.0, 0.0}, true);
  const double spent = seen.budget.spent();
  seen.budget.interrupt();
  EXPECT_EQ(seen.budget.spent(), spent);
  seen.see(all);
  // What it was told and has not done counts from the image on.
  seen.budget.command({0.02, 0.0, 0.0, 0.0}, true);
  seen.see(all, 5.0, kDt, {0.02, 0.0, 0.0, 0.0});
  seen.budget.interrupt();
  EXPECT_NEAR(seen.budget.spent(), 0.02 / seen.config.unconfirmed_turn, 1e-9);
  seen.budget.restart();
  EXPECT_EQ(seen.budget.spent(), 0.0) << "somebody has engaged";
}

TEST(EffectBudget, WhatNothingSpeaksAgainstAnyMoreIsOpenedAgain) {
  Seen seen;
  seen.see(all, 100.0);
  seen.budget.command({0.1, 0.0, 0.0, 0.0}, true);
  for (int k = 0; k < 20; ++k) seen.see(none, 0.0, 1.0);
  seen.budget.command({0.01, 0.0, 0.0, 0.0}, true);
  EXPECT_EQ(seen.budget.spent(), 0.0) << "20 s";
  for (int k = 0; k < 5; ++k) seen.see(none, 0.0, 1.0);
  seen.budget.command({0.01, 0.0, 0.0, 0.0}, true);
  EXPECT_NEAR(seen.budget.spent(), 0.01 / seen.config.unconfirmed_turn, 1e-9) << "25 s: from where it was opened";
}

TEST(EffectBudget, SomebodysOwnMotionIsNotSpent) {
  Seen seen;
  seen.see(none);
  seen.budget.command({0.01, 0.0, 0.0, 0.0}, true);
  seen.budget.command({0.3, 0.2, 0.1, 0.01}, false);
  EXPECT_NEAR(seen.budget.spent(), 0.01 / seen.config.unconfirmed_turn, 1e-9);
}

TEST(EffectBudget, AFrozenPictureIsNotOpenWhileABreathIsFollowed) {
  Seen seen;
  seen.breath_known = true;
  seen.see([](const EffectExplanation& e) { return !e.frozen(); });
  seen.budget.command({0.03, 0.0, 0.0, 0.0}, true);
  EXPECT_EQ(seen.budget.spent(), 0.0);
}

TEST(EffectBudget, SpinAndInsertionWaitForPanAndTilt) {
  Seen seen;
  seen.see([](const EffectExplanation& e) { return e.picture.isIdentity(); });  // no frozen one, no arm is open
  seen.budget.command({0.0, 0.0, 0.5 * seen.config.unconfirmed_turn, 0.75 * seen.config.unconfirmed_insertion}, true);
  EXPECT_NEAR(seen.budget.aside(), 0.75, 1e-9);
  seen.see(all);
  EXPECT_EQ(seen.budget.aside(), 0.0);
}

// Once it is not known how far the scope has gone, nothing of the budget is left.
TEST(EffectBudget, ADisplacementThatIsNotFiniteIsNotTakenForNone) {
  for (int k = 0; k < 4; ++k) {
    Seen seen;
    seen.see(none);
    Eigen::Vector4d displacement(0.001, 0.001, 0.001, 0.0001);
    displacement[k] = std::nan("");
    seen.budget.command(displacement, true);
    EXPECT_FALSE(seen.budget.spent() < 1.0) << k;
    EXPECT_EQ(seen.budget.aside() < 1.0, k < 2) << k;
  }
}

}  // namespace
}  // namespace laparoscope_servo::servo
