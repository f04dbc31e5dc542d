#include "tracking/search/region_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const cv::Size kSize(400, 320);
const geometry::Rectangle kRoi = {140, 100, 110, 110};

Eigen::Matrix3d shift(double x, double y) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topRightCorner<2, 1>() << x, y;
  return g;
}

class RegionSearchTest : public ::testing::Test {
 protected:
  cv::Mat scene_ = test::tissue(kSize, 61);
  TrackerConfig config_;
  Eigen::Matrix3d truth_ = shift(60.0, -40.0);
  std::vector<SearchPlace> tried_;  // in the last image

  RegionSearchTest() { config_.search.budget = 10.0; }  // all in one image

  struct Setup {
    RegionAligner aligner;
    RegionSearch search;
  };
  Setup setup() {
    Setup result{RegionAligner(config_), RegionSearch(config_)};
    result.aligner.setReference(scene_, kRoi);
    result.search.setReference(scene_, result.aligner);
    return result;
  }
  // One image; believes what an alignment with it brought to the truth.
  const Attempt& searchIn(const cv::Mat& image, Setup& s, const std::optional<Eigen::Matrix3d>& carried = std::nullopt,
                          const EsmState& last = EsmState(), const std::optional<EsmState>& awaited = std::nullopt) {
    tried_.clear();
    s.search.begin(last, carried, awaited);
    while (const auto place = s.search.next(image, s.aligner)) {
      tried_.push_back(*place);
      Attempt attempt;
      attempt.evidence.esm = s.aligner.align(image, place->start, nullptr, 32.0, place->limits).esm;
      attempt.evidence.zncc = 0.1 * static_cast<double>(tried_.size() % 3);  // the second is the best
      if (!(geometry::cornerDistance(attempt.evidence.esm.state.g, truth_, kRoi) < 1.0)) attempt.doubt = "elsewhere";
      if (s.search.judge(attempt, s.aligner)) break;
    }
    return s.search.best();
  }
  // How many images it takes until the ROI is found; 0 when it is not in so many.
  int imagesUntilFound(const cv::Mat& image, Setup& s, int most) {
    for (int k = 1; k <= most; ++k) {
      if (searchIn(image, s).doubt.empty()) return k;
    }
    return 0;
  }
  cv::Mat seen() const { return test::view(scene_, truth_, 1.0, 0.0, 2.0); }
};

TEST_F(RegionSearchTest, LooksFirstWhereItWasLast) {
  truth_ = shift(2.0, 1.0);
  Setup s = setup();
  EXPECT_EQ(searchIn(seen(), s).doubt, "");
  ASSERT_EQ(tried_.size(), 1u);
  EXPECT_EQ(tried_[0].by, Suggestion::kLast);
  EXPECT_LT(geometry::cornerDistance(tried_[0].start.g, truth_, kRoi), 3.0);
}

TEST_F(RegionSearchTest, ThenByFeaturesAndThenByCorrelation) {
  Setup s = setup();
  EXPECT_EQ(searchIn(seen(), s).doubt, "");
  EXPECT_EQ(s.search.suggestedBy(), Suggestion::kFeatures);
  EXPECT_EQ(tried_.back().by, Suggestion::kFeatures);
  EXPECT_LT(geometry::cornerDistance(tried_.back().start.g, truth_, kRoi), 15.0);
  // Nothing is believed there: the search goes on. Correlation turns nothing; features do.
  truth_ = shift(0.0, 0.0);
  searchIn(test::view(scene_, shift(60.0, -40.0), 1.0, 0.0, 2.0), s);
  ASSERT_EQ(tried_.back().by, Suggestion::kCorrelation);
  EXPECT_LT(std::abs(tried_.back().start.g(0, 1)), 1e-12);
}

TEST_F(RegionSearchTest, WithoutFurtherStagesOnlyWhereItWasLast) {
  config_.search.features = config_.search.correlation = false;
  Setup s = setup();
  EXPECT_NE(searchIn(seen(), s).doubt, "");
  EXPECT_LE(tried_.size(), 1u);
  truth_ = shift(20.0, 10.0);
  EXPECT_EQ(searchIn(seen(), s).doubt, "");
}

TEST_F(RegionSearchTest, OneStageAloneFindsIt) {
  for (const bool features : {true, false}) {
    config_.search.features = features;
    config_.search.correlation = !features;
    Setup s = setup();
    for (int turn = 0; turn < 3; ++turn) EXPECT_EQ(searchIn(seen(), s).doubt, "") << features << ' ' << turn;
    EXPECT_EQ(s.search.suggestedBy(), features ? Suggestion::kFeatures : Suggestion::kCorrelation);
  }
}

// Whatever the budget, it comes to an end, and what does not fit into an image is done in the next ones.
TEST_F(RegionSearchTest, ASmallBudgetTakesMoreImages) {
  Setup whole = setup();
  EXPECT_EQ(imagesUntilFound(seen(), whole, 1), 1);
  config_.search.correlation = false;
  config_.search.budget = 0.015;
  Setup usual = setup();
  const int images = imagesUntilFound(seen(), usual, 25);
  EXPECT_GT(images, 1);
  EXPECT_LE(images, 10);
  config_.search.budget = 0.001;
  Setup least = setup();
  EXPECT_GT(imagesUntilFound(seen(), least, 100), images);
}

TEST_F(RegionSearchTest, APlaceFoundSomeImagesAgoIsCarriedToThePresentOne) {
  config_.search.budget = 0.005;
  config_.search.correlation = false;
  Setup s = setup();
  int images = 0;
  for (bool found = false; !found && images < 60; ++images) {
    truth_ = shift(60.0 + 0.8 * images, -40.0);
    found = searchIn(seen(), s).doubt.empty();
  }
  EXPECT_LT(images, 60);
  EXPECT_EQ(s.search.suggestedBy(), Suggestion::kFeatures);
}

// So that no image takes longer than its budget allows, and what has been done is not lost.
TEST_F(RegionSearchTest, AnAlignmentThatIsInterruptedGoesOnInTheNextImage) {
  config_.search.budget = 0.015;
  truth_ = shift(2.0, 1.0);
  const cv::Mat image = seen();
  for (const bool carried : {false, true}) {
    Setup s = setup();
    Eigen::Matrix3d reached = shift(6.0, 3.0);
    for (int k = 0; k < 4; ++k) {
      s.search.begin(EsmState(), carried && k == 0 ? std::optional<Eigen::Matrix3d>(reached) : std::nullopt);
      const auto place = s.search.next(image, s.aligner);
      ASSERT_TRUE(place);
      EXPECT_GT(place->limits.most_work, 0.0);
      EXPECT_LT(place->limits.most_work, 1000.0);
      EXPECT_EQ(place->resumed, k < 3 ? k : 0) << "not for ever";
      EXPECT_EQ(place->limits.coarsest == 1, k > 0 && k < 3);
      if (k > 0 && k < 3) {
        EXPECT_LT(geometry::cornerDistance(place->start.g, reached, kRoi), 3.0);
      }
      Attempt attempt;
      attempt.evidence.esm.status = EsmStatus::kInterrupted;
      attempt.evidence.esm.work = place->limits.most_work;
      attempt.evidence.esm.level = 1;
      reached = shift(2.0 + 0.5 * k, 1.0);
      attempt.evidence.esm.state.g = reached;
      attempt.doubt = "no time";
      EXPECT_FALSE(s.search.judge(attempt, s.aligner));
      EXPECT_FALSE(s.search.next(image, s.aligner)) << "the budget is used up";
      EXPECT_EQ(s.search.best().doubt, "no time");
    }
  }
}

TEST_F(RegionSearchTest, WhereItWasCarriedComesBeforeAndIsSaid) {
  Setup s = setup();
  EXPECT_EQ(searchIn(seen(), s, shift(58.0, -41.0)).doubt, "");
  EXPECT_EQ(s.search.suggestedBy(), Suggestion::kCarried);
  EXPECT_EQ(tried_.size(), 1u);
  // A robot that is wrong: the search goes on.
  EXPECT_EQ(searchIn(seen(), s, shift(-80.0, 60.0)).doubt, "");
  EXPECT_NE(s.search.suggestedBy(), Suggestion::kCarried);
}

TEST_F(RegionSearchTest, WhatWaitsForConfirmationComesFirst) {
  Setup s = setup();
  EsmState awaited;
  awaited.g = truth_;
  EXPECT_EQ(searchIn(seen(), s, shift(0.0, 5.0), EsmState(), awaited).doubt, "");
  ASSERT_EQ(tried_.size(), 1u);
  EXPECT_EQ(tried_[0].by, Suggestion::kConfirmation);
  EXPECT_LT(geometry::cornerDistance(tried_[0].start.g, truth_, kRoi), 1e-9);
}

TEST_F(RegionSearchTest, AlignsNoPlaceThatDoesNotLookLikeTheRegionAndSaysSo) {
  Setup s = setup();
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Attempt& best = searchIn(test::view(test::tissue(kSize, 90 + seed), truth_, 1.0, 0.0, 2.0, seed), s);
    EXPECT_LE(tried_.size(), 1u);
    EXPECT_NE(best.doubt, "");
  }
  const Attempt& black = searchIn(cv::Mat::zeros(kSize, CV_8UC3), s);
  EXPECT_TRUE(tried_.empty());
  EXPECT_NE(black.doubt.find("no place looks like the ROI: correlation 0, expected"), std::string::npos) << black.doubt;
}

TEST_F(RegionSearchTest, TheBestAttemptIsReported) {
  const cv::Mat image = seen();
  truth_ = shift(0.0, 0.0);  // nothing is believed
  Setup s = setup();
  const Attempt& best = searchIn(image, s, shift(58.0, -41.0));
  ASSERT_GE(tried_.size(), 3u);
  EXPECT_EQ(best.doubt, "elsewhere");
  EXPECT_NEAR(best.evidence.zncc, 0.2, 1e-12);
  EXPECT_EQ(s.search.suggestedBy(), tried_[1].by);
}

TEST_F(RegionSearchTest, AsksForMoreThanAnAttemptThatNobodyDoubts) {
  Setup s = setup();
  const auto withStatus = [&](EsmStatus status, const cv::Mat& image) {
    s.search.begin(EsmState(), truth_);
    const auto place = s.search.next(image, s.aligner);
    Attempt attempt;
    attempt.evidence.esm = s.aligner.align(image, place->start, nullptr, 32.0).esm;
    attempt.evidence.esm.status = status;
    const bool believed = s.search.judge(attempt, s.aligner);
    EXPECT_EQ(believed, s.search.best().doubt.empty());
    return s.search.best().doubt;
  };
  EXPECT_EQ(withStatus(EsmStatus::kConverged, seen()), "");
  EXPECT_NE(withStatus(EsmStatus::kMaxIterations, seen()), "");
  // The same shading without the fine structure.
  cv::Mat blurred;
  cv::GaussianBlur(seen(), blurred, cv::Size(), 6.0);
  EXPECT_NE(withStatus(EsmStatus::kConverged, blurred), "");
}

// Of tissue that has changed since, so much that the reference does not find it.
TEST_F(RegionSearchTest, KeepsClearAndNewViewsThatItThenFinds) {
  cv::Mat changed;
  cv::addWeighted(scene_, 0.35, test::tissue(kSize, 63), 0.65, 0.0, changed);
  const Eigen::Matrix3d close =
      geometry::normaliseDeterminant((Eigen::Matrix3d() << 1.4, 0.0, -70.0, 0.0, 1.4, -60.0, 0.0, 0.0, 1.0).finished());
  truth_ = geometry::normaliseDeterminant(shift(25.0, 12.0) * close);
  config_.search.correlation = false;
  const cv::Mat now = test::view(changed, truth_, 1.0, 0.0, 2.0);
  const auto suggestedAfterKeeping = [&](double visible_fraction, double zncc, int images) {
    Setup s = setup();
    Evidence clear;
    clear.visible_fraction = visible_fraction;
    clear.zncc = zncc;
    for (int k = 0; k < images; ++k)
      s.search.keepKeyframe(test::view(changed, close, 1.0, 0.0, 2.0), 0.05 * k, clear, close, s.aligner);
    searchIn(now, s);
    for (const SearchPlace& place : tried_) {
      if (geometry::cornerDistance(place.start.g, truth_, kRoi) < 40.0) return true;
    }
    return false;
  };
  EXPECT_TRUE(suggestedAfterKeeping(0.95, 0.95, 1));
  EXPECT_FALSE(suggestedAfterKeeping(0.6, 0.95, 1));
  EXPECT_FALSE(suggestedAfterKeeping(0.95, 0.8, 1));
  // The most recent view is kept every now and then, also where it is worse.
  EXPECT_TRUE(suggestedAfterKeeping(0.6, 0.8, 10));
  EXPECT_FALSE(suggestedAfterKeeping(0.4, 0.8, 10));
}

}  // namespace
}  // namespace laparoscope_servo::tracking
