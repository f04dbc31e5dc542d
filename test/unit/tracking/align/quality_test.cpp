#include "tracking/align/quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace laparoscope_servo::tracking {
namespace {

Evidence good() {
  Evidence e;
  e.roi = {100, 100, 101, 101};
  e.esm.status = EsmStatus::kConverged;
  e.esm.corner_error = 0.1;
  e.predicted = Eigen::Matrix3d::Identity();
  e.from_track = true;
  e.visible_fraction = 0.9;
  e.zncc = 0.95;
  e.esm.sigma = 2.0;
  for (int k = 0; k < 50; ++k) e.record.add(0.95, 2.0, 1.0, 0.9, 0.04);
  return e;
}

TEST(Doubt, IsEmptyWhenEveryTestIsPassed) {
  EXPECT_EQ(doubt(good(), QualityConfig()), "");
}

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
      {"interrupted", "within the time", [](Evidence& e) { e.esm.status = EsmStatus::kInterrupted; }},
      {"moving", "moving",
       [](Evidence& e) {
         e.esm.status = EsmStatus::kMaxIterations;
         e.esm.last_step = 3.0;
       }},
      {"moving nan", "moving",
       [=](Evidence& e) {
         e.esm.status = EsmStatus::kMaxIterations;
         e.esm.last_step = nan;
       }},
      {"covered", "visible", [](Evidence& e) { e.visible_fraction = 0.05; }},
      {"covered nan", "visible", [=](Evidence& e) { e.visible_fraction = nan; }},
      {"mostly covered", "visible fraction of what is in the image", [](Evidence& e) { e.visible_fraction = 0.14; }},
      {"in image nan", "visible", [=](Evidence& e) { e.visible_fraction = e.in_image = nan; }},
      {"folded", "convex", [](Evidence& e) { e.esm.state.g(0, 0) = -1.0; }},
      {"nan", "convex", [=](Evidence& e) { e.esm.state.g(0, 0) = nan; }},
      {"large", "area", [](Evidence& e) { e.esm.state.g(0, 0) = e.esm.state.g(1, 1) = 3.0; }},
      {"small", "area", [](Evidence& e) { e.esm.state.g(0, 0) = e.esm.state.g(1, 1) = 0.3; }},
      {"unlike", "correlation", [](Evidence& e) { e.zncc = 0.3; }},
      {"unlike nan", "correlation", [=](Evidence& e) { e.zncc = nan; }},
      {"worse than it was", "correlation", [](Evidence& e) { e.zncc = 0.75; }},
      {"residual", "residual", [](Evidence& e) { e.esm.sigma = 6.0; }},
      {"residual nan", "residual", [=](Evidence& e) { e.esm.sigma = nan; }},
      {"vague", "corner error", [](Evidence& e) { e.esm.corner_error = 7.0; }},
      {"vague inf", "corner error", [](Evidence& e) { e.esm.corner_error = INFINITY; }},
      {"vague centre", "error of the centre", [](Evidence& e) { e.esm.centre_error = 3.0; }},
      {"vague centre nan", "error of the centre", [=](Evidence& e) { e.esm.centre_error = nan; }},
      {"pieces elsewhere", "pieces of the region off",
       [](Evidence& e) {
         e.blocks = {30, 20, 4.5};
       }},
      {"pieces elsewhere nan", "pieces of the region off",
       [=](Evidence& e) {
         e.blocks = {30, 20, nan};
       }},
      {"few pieces elsewhere", "pieces of the region off",
       [](Evidence& e) {
         e.blocks = {10, 3, 4.5};
       }},
      {"no piece", "pieces of the region found",
       [=](Evidence& e) {
         e.blocks = {30, 2, 0.1};
       }},
      {"jump", "jump", [](Evidence& e) { e.esm.state.g(0, 2) = 100.0; }},
  };
  for (const Flaw& flaw : flaws) {
    Evidence e = good();
    flaw.apply(e);
    EXPECT_NE(doubt(e, QualityConfig()).find(flaw.word), std::string::npos)
        << flaw.name << ": " << doubt(e, QualityConfig());
  }
}

TEST(Doubt, AsksMoreOfASearch) {
  const std::vector<Flaw> flaws = {
      {"visible", "visible", [](Evidence& e) { e.visible_fraction = 0.2; }},
      {"correlation", "correlation", [](Evidence& e) { e.zncc = 0.84; }},
      {"residual", "residual", [](Evidence& e) { e.esm.sigma = 4.5; }},
      {"gain", "gain", [](Evidence& e) { e.esm.state.gain = 2.5; }},
      {"gain nan", "gain", [](Evidence& e) { e.esm.state.gain = std::nan(""); }},
  };
  for (const Flaw& flaw : flaws) {
    Evidence e = good();
    flaw.apply(e);
    if (std::isfinite(e.esm.state.gain)) {
      EXPECT_EQ(doubt(e, QualityConfig()), "") << flaw.name;
    }
    e.from_track = false;
    EXPECT_NE(doubt(e, QualityConfig()).find(flaw.word), std::string::npos) << flaw.name;
  }
}

// A feed with hardly any noise leaves a record that the same tissue never reaches again.
TEST(Doubt, ARecordDoesNotAskForMoreThanIsGood) {
  Evidence e = good();
  for (int k = 0; k < 200; ++k) e.record.add(0.999, 1.0, 0.1, 1.0, 0.04);
  e.from_track = false;
  e.zncc = 0.92;
  e.esm.sigma = 3.5;
  EXPECT_EQ(doubt(e, QualityConfig()), "");
}

TEST(Doubt, TheRecordCountsLessTheLongerTheRegionHasNotBeenSeen) {
  Evidence e = good();
  e.from_track = false;
  e.zncc = 0.8;
  e.esm.sigma = 5.5;
  EXPECT_NE(doubt(e, QualityConfig()), "");
  e.unseen = 2.0;
  EXPECT_EQ(doubt(e, QualityConfig()), "");
  e.unseen = 1000.0;  // but never nothing
  e.zncc = 0.6;
  EXPECT_NE(doubt(e, QualityConfig()), "");
}

TEST(Doubt, PiecesThatAreWhereTheyShouldBeAreTheRegionWhateverItLooksLike) {
  Evidence e = good();
  e.from_track = false;
  e.zncc = 0.55;
  e.esm.sigma = 20.0;
  e.esm.corner_error = 4.0;
  EXPECT_NE(doubt(e, QualityConfig()), "");
  e.blocks = {30, 12, 1.0};
  EXPECT_EQ(doubt(e, QualityConfig()), "");
  e.blocks.off = 3.5;
  EXPECT_NE(doubt(e, QualityConfig()), "");
  e.blocks = {30, 7, 1.0};  // too small a share of them
  EXPECT_NE(doubt(e, QualityConfig()), "");
  e.blocks = {8, 5, 1.0};  // too few
  EXPECT_NE(doubt(e, QualityConfig()), "");
  e.blocks = {30, 12, 1.0};
  e.visible_fraction = 0.2;  // what a return asks for is asked of them, too
  EXPECT_NE(doubt(e, QualityConfig()).find("visible"), std::string::npos);
}

// Of a ROI that has left the image by half, less has to be visible.
TEST(Doubt, WhatIsOutsideTheImageIsNotCovered) {
  Evidence e = good();
  e.visible_fraction = 0.14;
  EXPECT_NE(doubt(e, QualityConfig()), "");
  e.in_image = 0.5;
  EXPECT_EQ(doubt(e, QualityConfig()), "");
}

TEST(Doubt, TheLightMayChangeMoreTheLongerItHasNotBeenSeen) {
  Evidence e = good();
  e.from_track = false;
  e.esm.state.gain = 1.8 * e.last_gain;
  EXPECT_NE(doubt(e, QualityConfig()).find("gain"), std::string::npos);
  e.unseen = 1.0;
  EXPECT_EQ(doubt(e, QualityConfig()), "");
  e.esm.state.gain = e.last_gain / 1.8;
  EXPECT_EQ(doubt(e, QualityConfig()), "");
}

TEST(Doubt, WhatTheColoursShowOfTheLightCountsAsWell) {
  Evidence e = good();
  e.from_track = false;
  e.esm.state.gain = 2.2 * e.last_gain;
  e.light_gain = 2.0 * e.last_gain;
  EXPECT_EQ(doubt(e, QualityConfig()), "");
  e.light_gain = e.last_gain;
  EXPECT_NE(doubt(e, QualityConfig()).find("gain"), std::string::npos);
}

TEST(Doubt, WhatIsTooBadDependsOnTheRecord) {
  Evidence e = good();
  e.zncc = 0.7;
  e.esm.sigma = 7.0;
  EXPECT_NE(doubt(e, QualityConfig()), "");
  e.record = TrackRecord();  // nothing known yet
  EXPECT_EQ(doubt(e, QualityConfig()), "");
}

TEST(AllowedJump, ShrinksWithWhatIsVisible) {
  const Evidence e = good();
  const QualityConfig q;
  EXPECT_NEAR(allowedJump(e.record, q, e.roi, 0.9, 0.1), q.max_jump * std::hypot(101.0, 101.0), 1e-9);
  double last = 1e9;
  for (double visible = 1.0; visible >= 0.0; visible -= 0.05) {
    const double now = allowedJump(e.record, q, e.roi, visible, 0.1);
    EXPECT_LE(now, last);
    last = now;
  }
  EXPECT_NEAR(last, 3.0 + 4.0 * e.record.innovation() + 0.3, 1e-9);
}

TEST(TrackRecord, BeginsWithTheFirstImageAndThenFollowsSlowly) {
  TrackRecord record;
  record.add(0.9, 3.0, 2.0, 1.0, 0.04);
  EXPECT_DOUBLE_EQ(record.zncc(), 0.9);
  EXPECT_DOUBLE_EQ(record.sigma(), 3.0);
  EXPECT_DOUBLE_EQ(record.innovation(), 2.0);
  for (int k = 0; k < 200; ++k) record.add(0.9, 3.0, 2.0, 1.0, 0.04);
  record.add(0.5, 30.0, 20.0, 1.0, 0.04);
  EXPECT_GT(record.zncc(), 0.87);
  EXPECT_LT(record.sigma(), 5.0);
}

TEST(TrackRecord, LearnsNothingOfLikenessFromWhatIsHardlyVisible) {
  TrackRecord record;
  const double zncc = record.zncc();
  record.add(0.2, 50.0, 1.0, 0.1, 0.04);
  EXPECT_EQ(record.zncc(), zncc);
  EXPECT_DOUBLE_EQ(record.innovation(), 1.0);
}

TEST(Doubt, NearlyConvergedIsGoodEnough) {
  Evidence e = good();
  e.esm.status = EsmStatus::kMaxIterations;
  e.esm.last_step = 0.1;
  EXPECT_EQ(doubt(e, QualityConfig()), "");
}

// Blocks in one place say nothing of the corners: the estimate turns about them, and its corner error grows.
TEST(Doubt, PiecesInOnePlaceDoNotMakeUpForUncertainCorners) {
  Evidence e = good();
  e.esm.corner_error = 7.0;
  e.blocks = {10, 10, 0.3};
  e.blocks.spread = 0.3;
  EXPECT_NE(doubt(e, QualityConfig()).find("corner error"), std::string::npos);
  e.blocks.spread = 0.4;
  EXPECT_EQ(doubt(e, QualityConfig()), "");
  e.blocks.spread = 0.3;
  e.esm.corner_error = 4.5;  // less than an error that is wrong
  EXPECT_EQ(doubt(e, QualityConfig()), "");
  QualityConfig config;
  config.max_corner_error = 8.0;
  e.esm.corner_error = 7.0;
  EXPECT_EQ(doubt(e, config), "");
}

// Where more is visible, more of the blocks have to be found; a search has to find some in any case.
TEST(Doubt, AsksForMoreBlocksTheMoreIsVisible) {
  const auto refused = [](double visible, int confident, bool from_track) {
    Evidence e = good();
    e.visible_fraction = visible;
    e.blocks = {36, confident, 0.3};
    e.from_track = from_track;
    return doubt(e, QualityConfig()).find("pieces of the region found") != std::string::npos;
  };
  for (const bool from_track : {true, false}) {
    EXPECT_TRUE(refused(0.57, 5, from_track));
    EXPECT_FALSE(refused(0.57, 6, from_track));
    EXPECT_TRUE(refused(0.9, 8, from_track));
    EXPECT_FALSE(refused(0.9, 9, from_track));
  }
  EXPECT_FALSE(refused(0.3, 0, true)) << "beside an instrument a block is covered, too";
  EXPECT_TRUE(refused(0.3, 2, false));
  EXPECT_FALSE(refused(0.3, 3, false));
}

// The gates may take all that has texture for covered, and what is left agrees with any place.
TEST(Doubt, AsksForBlocksThatNothingCoversAndForOthersAfterAWhile) {
  Evidence e = good();
  e.visible_fraction = 0.3;
  e.blocks = {36, 0, std::numeric_limits<double>::quiet_NaN(), 5};
  EXPECT_EQ(doubt(e, QualityConfig()), "");
  e.blocks.visible = 6;
  EXPECT_NE(doubt(e, QualityConfig()).find("pieces of the region found"), std::string::npos);
  e.blocks.visible = 5;
  e.unproven = 0.25;
  e.visible_fraction = 0.2;
  EXPECT_EQ(doubt(e, QualityConfig()), "") << "beside an instrument a block is covered, too";
  e.visible_fraction = 0.3;
  EXPECT_NE(doubt(e, QualityConfig()).find("pieces of the region found"), std::string::npos);
  e.blocks.confident = 4;
  e.blocks.off = 1.0;
  EXPECT_EQ(doubt(e, QualityConfig()), "");
  e.blocks = {7, 0, std::numeric_limits<double>::quiet_NaN(), 7};
  EXPECT_EQ(doubt(e, QualityConfig()), "") << "fewer than can tell";
}

// What is not covered more than when blocks were found has to be found again soon.
TEST(Doubt, BlocksAreMissedSoonerWhereNothingMoreIsCovered) {
  const auto refused = [](double visible, double unproven) {
    Evidence e = good();
    e.visible_fraction = visible;
    e.blocks = {36, 0, std::numeric_limits<double>::quiet_NaN(), 0};
    e.proven_visible = 0.4;
    e.unproven = unproven;
    return doubt(e, QualityConfig()).find("pieces of the region found") != std::string::npos;
  };
  EXPECT_FALSE(refused(0.36, 0.08)) << "an image may be blurred";
  EXPECT_TRUE(refused(0.36, 0.12));
  EXPECT_FALSE(refused(0.30, 0.12)) << "more is covered";
  EXPECT_TRUE(refused(0.30, 0.22));
}

// What was found with enough of it visible is confirmed by less: under light that flickers every second image shows
// less.
TEST(Doubt, ConfirmsWithAsMuchVisibleAsTrackingTakes) {
  Evidence e = good();
  e.from_track = false;
  e.visible_fraction = 0.25;
  e.blocks = {36, 9, 0.3, 9};
  EXPECT_NE(doubt(e, QualityConfig()).find("visible fraction"), std::string::npos);
  e.confirming = true;
  EXPECT_EQ(doubt(e, QualityConfig()), "");
  e.visible_fraction = 0.05;
  EXPECT_NE(doubt(e, QualityConfig()).find("visible fraction"), std::string::npos);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
