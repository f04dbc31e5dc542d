#include "tracking/search/region_search.h"

#include <gtest/gtest.h>

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
  std::vector<Eigen::Matrix3d> tried_;  // where attempts started, since the last search

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
  // Believes what an alignment, with `image`, brought to the truth.
  RegionSearch::Found searchIn(const cv::Mat& image, Setup& s,
                               const std::optional<Eigen::Matrix3d>& carried = std::nullopt) {
    tried_.clear();
    return s.search.search(image, s.aligner, EsmState(), carried, [&](const EsmState& start) {
      tried_.push_back(start.g);
      Attempt attempt;
      attempt.evidence.esm = s.aligner.align(image, start, nullptr, 32.0).esm;
      if (!(test::cornerDistance(attempt.evidence.esm.state.g, truth_, kRoi) < 1.0)) attempt.doubt = "elsewhere";
      return attempt;
    });
  }
  cv::Mat seen() const { return test::view(scene_, truth_, 1.0, 0.0, 2.0); }
};

TEST_F(RegionSearchTest, LooksFirstWhereItWasLast) {
  truth_ = shift(2.0, 1.0);
  Setup s = setup();
  EXPECT_EQ(searchIn(seen(), s).attempt.doubt, "");
  ASSERT_EQ(tried_.size(), 1u);
  EXPECT_EQ(tried_[0], Eigen::Matrix3d::Identity());
}

TEST_F(RegionSearchTest, ThenByFeaturesAndByCorrelationInTurn) {
  Setup s = setup();
  for (int turn = 0; turn < 3; ++turn) {
    const RegionSearch::Found found = searchIn(seen(), s);
    EXPECT_EQ(found.attempt.doubt, "") << turn;
    EXPECT_FALSE(found.where_carried);
    ASSERT_GE(tried_.size(), 2u) << turn;
    EXPECT_LE(tried_.size(), 3u) << turn;
    EXPECT_EQ(tried_[0], Eigen::Matrix3d::Identity());
    EXPECT_LT(test::cornerDistance(tried_.back(), truth_, kRoi), 15.0) << turn;
  }
  // Correlation goes by whole pixels of its level, and turns nothing; features do neither.
  searchIn(seen(), s);
  const Eigen::Matrix3d by_correlation = tried_.back();
  EXPECT_NEAR(by_correlation(0, 1), 0.0, 1e-12);
  EXPECT_NEAR(by_correlation(0, 0), 1.0, 1e-12);
  s.search.restart();
  searchIn(seen(), s);
  EXPECT_NE(tried_.back()(0, 1), 0.0);
}

TEST_F(RegionSearchTest, WithoutFurtherStagesOnlyWhereItWasLast) {
  config_.search.features = config_.search.correlation = false;
  Setup s = setup();
  EXPECT_NE(searchIn(seen(), s).attempt.doubt, "");
  EXPECT_EQ(tried_.size(), 1u);
}

TEST_F(RegionSearchTest, OneStageAloneIsAskedEveryTime) {
  for (const bool features : {true, false}) {
    config_.search.features = features;
    config_.search.correlation = !features;
    Setup s = setup();
    for (int turn = 0; turn < 3; ++turn) EXPECT_EQ(searchIn(seen(), s).attempt.doubt, "") << features << ' ' << turn;
  }
}

TEST_F(RegionSearchTest, WhereItWasCarriedComesBeforeAndIsSaid) {
  Setup s = setup();
  const RegionSearch::Found found = searchIn(seen(), s, shift(58.0, -41.0));
  EXPECT_EQ(found.attempt.doubt, "");
  EXPECT_TRUE(found.where_carried);
  EXPECT_EQ(tried_.size(), 1u);
  // A robot that is wrong: the search goes on.
  const RegionSearch::Found despite = searchIn(seen(), s, shift(-80.0, 60.0));
  EXPECT_EQ(despite.attempt.doubt, "");
  EXPECT_FALSE(despite.where_carried);
  EXPECT_EQ(tried_[0], shift(-80.0, 60.0));
  EXPECT_EQ(tried_[1], Eigen::Matrix3d::Identity());
}

TEST_F(RegionSearchTest, WhatWaitsForConfirmationComesFirst) {
  Setup s = setup();
  EsmResult found;
  found.state.g = truth_;
  s.search.confirmation().add(found, kRoi, TrackRecord());
  EXPECT_EQ(searchIn(seen(), s, shift(0.0, 5.0)).attempt.doubt, "");
  ASSERT_EQ(tried_.size(), 1u);
  EXPECT_LT(test::cornerDistance(tried_[0], truth_, kRoi), 1e-9);
}

TEST_F(RegionSearchTest, AsksForMoreThanAnAttemptThatNobodyDoubts) {
  Setup s = setup();
  const auto withStatus = [&](EsmStatus status) {
    const cv::Mat image = seen();
    return s.search
        .search(image, s.aligner, EsmState(), truth_,
                [&](const EsmState& start) {
                  Attempt attempt;
                  attempt.evidence.esm = s.aligner.align(image, start, nullptr, 32.0).esm;
                  attempt.evidence.esm.status = status;
                  return attempt;
                })
        .attempt.doubt;
  };
  EXPECT_EQ(withStatus(EsmStatus::kConverged), "");
  EXPECT_NE(withStatus(EsmStatus::kMaxIterations), "");
  // The same shading without the fine structure.
  cv::Mat blurred;
  cv::GaussianBlur(scene_, blurred, cv::Size(), 6.0);
  truth_.setIdentity();
  const RegionSearch::Found found = searchIn(blurred, s);
  EXPECT_NE(found.attempt.doubt, "");
}

TEST_F(RegionSearchTest, KeepsClearAndNewViewsThatItThenFinds) {
  const Eigen::Matrix3d close = geometry::normaliseDeterminant(
      (Eigen::Matrix3d() << 2.6, 0.0, -307.0, 0.0, 2.6, -243.0, 0.0, 0.0, 1.0).finished());
  truth_ = geometry::normaliseDeterminant(shift(25.0, 12.0) * close);
  config_.search.correlation = false;
  config_.quality.max_area_ratio = 10.0;
  const cv::Mat now = seen();
  const auto findsAfterKeeping = [&](double visible_fraction, double zncc) {
    Setup s = setup();
    Evidence clear;
    clear.visible_fraction = visible_fraction;
    clear.zncc = zncc;
    s.search.keepView(test::view(scene_, close, 1.0, 0.0, 2.0), clear, close, s.aligner);
    return searchIn(now, s).attempt.doubt.empty();
  };
  EXPECT_TRUE(findsAfterKeeping(0.95, 0.95));
  EXPECT_FALSE(findsAfterKeeping(0.6, 0.95));
  EXPECT_FALSE(findsAfterKeeping(0.95, 0.8));
}

}  // namespace
}  // namespace laparoscope_servo::tracking
