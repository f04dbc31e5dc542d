#include "laparoscope_servo/tracking/quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace laparoscope_servo::tracking {
namespace {

Evidence good() {
  Evidence e;
  e.roi = {100, 100, 101, 101};
  e.esm.status = EsmStatus::kConverged;
  e.esm.corner_error = 0.1;
  e.predicted = Eigen::Matrix3d::Identity();
  e.predicted_from_track = true;
  e.visible_fraction = 0.9;
  e.zncc = 0.95;
  return e;
}

TEST(Doubt, IsEmptyWhenEveryTestIsPassed) { EXPECT_EQ(doubt(good(), QualityConfig()), ""); }

struct Flaw {
  const char* name;
  const char* word;  // what the reason must speak of
  std::function<void(Evidence&)> apply;
};

TEST(Doubt, NamesEachFlawByItself) {
  const double nan = std::nan("");
  const std::vector<Flaw> flaws = {
      {"ill", "determine", [](Evidence& e) { e.esm.status = EsmStatus::kIllConditioned; }},
      {"out", "infinity", [](Evidence& e) { e.esm.status = EsmStatus::kOutOfView; }},
      {"moving", "moving", [](Evidence& e) { e.esm.status = EsmStatus::kMaxIterations; e.esm.last_step = 3.0; }},
      {"moving nan", "moving", [=](Evidence& e) { e.esm.status = EsmStatus::kMaxIterations; e.esm.last_step = nan; }},
      {"covered", "visible", [](Evidence& e) { e.visible_fraction = 0.05; }},
      {"covered nan", "visible", [=](Evidence& e) { e.visible_fraction = nan; }},
      {"folded", "convex", [](Evidence& e) { e.esm.state.g(0, 0) = -1.0; }},
      {"nan", "convex", [=](Evidence& e) { e.esm.state.g(0, 0) = nan; }},
      {"large", "area", [](Evidence& e) { e.esm.state.g(0, 0) = e.esm.state.g(1, 1) = 3.0; }},
      {"small", "area", [](Evidence& e) { e.esm.state.g(0, 0) = e.esm.state.g(1, 1) = 0.3; }},
      {"unlike", "correlation", [](Evidence& e) { e.zncc = 0.3; }},
      {"unlike nan", "correlation", [=](Evidence& e) { e.zncc = nan; }},
      {"vague", "corner error", [](Evidence& e) { e.esm.corner_error = 7.0; }},
      {"vague inf", "corner error", [](Evidence& e) { e.esm.corner_error = INFINITY; }},
      {"jump", "jump", [](Evidence& e) { e.esm.state.g(0, 2) = 100.0; }},
  };
  for (const Flaw& flaw : flaws) {
    Evidence e = good();
    flaw.apply(e);
    EXPECT_NE(doubt(e, QualityConfig()).find(flaw.word), std::string::npos) << flaw.name << ": " << doubt(e, QualityConfig());
  }
}

TEST(Doubt, AJumpFromASearchIsNone) {
  Evidence e = good();
  e.esm.state.g(0, 2) = 100.0;
  e.predicted_from_track = false;
  EXPECT_EQ(doubt(e, QualityConfig()), "");
}

TEST(Doubt, NearlyConvergedIsGoodEnough) {
  Evidence e = good();
  e.esm.status = EsmStatus::kMaxIterations;
  e.esm.last_step = 0.1;
  EXPECT_EQ(doubt(e, QualityConfig()), "");
}

}  // namespace
}  // namespace laparoscope_servo::tracking
