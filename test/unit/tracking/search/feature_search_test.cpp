#include "tracking/search/feature_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const cv::Size kSize(480, 360);
const geometry::Rectangle kRoi = {170, 110, 130, 120};

// A view that turns by `angle` and zooms about the ROI's centre, which goes to `to`; `tilt` foreshortens it.
Eigen::Matrix3d motion(double zoom, double angle, double tilt, const Eigen::Vector2d& to) {
  Eigen::Matrix3d tilted = Eigen::Matrix3d::Identity();
  tilted(0, 0) = std::cos(tilt);
  tilted(2, 0) = std::sin(tilt) / 500.0;
  return test::zoomAndTurn(kRoi, zoom, angle, tilted, to);
}

class FeatureSearchTest : public ::testing::Test {
 protected:
  cv::Mat scene_ = test::tissue(kSize, 41);
  Keyframes views_{8};
  FeatureSearch search_{TrackerConfig()};
  cv::Mat1f weights_ = cv::Mat1f(120, 130, 1.0f);

  void SetUp() override { views_.setReference(scene_, kRoi, weights_); }
  std::vector<FeatureCandidate> find(const cv::Mat& image) { return search_.find(image, image::kLuma, views_); }
  cv::Mat seen(const Eigen::Matrix3d& g, unsigned seed = 1) const {
    return test::view(scene_, g, 0.9, 10.0, 2.0, seed);
  }
};

TEST_F(FeatureSearchTest, FindsTheRegionMovedTurnedAndZoomed) {
  for (const double zoom : {0.75, 1.0, 1.4}) {
    for (const double angle : {0.0, 0.8, -1.57}) {
      const Eigen::Matrix3d g = motion(zoom, angle, 0.2, {200.0, 210.0});
      const std::vector<FeatureCandidate> found = find(seen(g));
      ASSERT_FALSE(found.empty()) << zoom << ' ' << angle;
      EXPECT_LT(geometry::cornerDistance(found[0].g, g, kRoi), 15.0) << zoom << ' ' << angle;
      EXPECT_NEAR(found[0].g.determinant(), 1.0, 1e-9);
      EXPECT_GE(found[0].inliers, SearchConfig().min_inliers);
    }
  }
}

TEST_F(FeatureSearchTest, AnImageThatIsScaledDownGivesPlacesInItsOwnPixels) {
  TrackerConfig config;
  config.search.max_pixels = 60000;
  search_ = FeatureSearch(config);
  const Eigen::Matrix3d g = motion(1.1, 0.5, 0.0, {250.0, 170.0});
  const std::vector<FeatureCandidate> found = find(seen(g));
  ASSERT_FALSE(found.empty());
  EXPECT_LT(geometry::cornerDistance(found[0].g, g, kRoi), 15.0);
}

// The mask of a large region has fewer pixels than the region; the same part of it is covered.
TEST_F(FeatureSearchTest, AMaskOfFewerPixelsCoversTheSamePart) {
  const cv::Mat image = seen(motion(1.0, 0.3, 0.0, {230.0, 190.0}));
  std::vector<std::size_t> points;
  for (const int scale : {1, 2}) {
    cv::Mat1f weights(120 / scale, 130 / scale, 1.0f);
    weights(cv::Rect(0, 0, weights.cols, weights.rows / 2)).setTo(0.0f);
    views_.setReference(scene_, kRoi, weights);
    const std::vector<FeatureCandidate> found = find(image);
    ASSERT_FALSE(found.empty());
    for (const cv::Point2f& p : views_.at(0).features.points) {
      const bool covered = p.x > kRoi.x + 3 && p.x < kRoi.x + kRoi.width - 4 && p.y > kRoi.y + 3 && p.y < kRoi.y + 56;
      EXPECT_FALSE(covered) << p << ' ' << scale;
    }
    points.push_back(views_.at(0).features.points.size());
  }
  EXPECT_EQ(points[0], points[1]);
}

TEST_F(FeatureSearchTest, TakesGreyImages) {
  cv::Mat grey, moved;
  cv::cvtColor(scene_, grey, cv::COLOR_BGR2GRAY);
  views_.setReference(grey, kRoi, weights_);
  const Eigen::Matrix3d g = motion(1.0, 0.4, 0.0, {230.0, 190.0});
  cv::cvtColor(seen(g), moved, cv::COLOR_BGR2GRAY);
  const std::vector<FeatureCandidate> found = find(moved);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(geometry::cornerDistance(found[0].g, g, kRoi), 15.0);
}

TEST_F(FeatureSearchTest, BearsAMixtureWithNegativeWeights) {
  const Eigen::Matrix3d g = motion(1.0, 0.4, 0.0, {230.0, 190.0});
  const std::vector<FeatureCandidate> found = search_.find(seen(g), {-0.2f, 0.6f, 0.2f}, views_);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(geometry::cornerDistance(found[0].g, g, kRoi), 15.0);
}

TEST_F(FeatureSearchTest, FindsNothingInSmokeOrDarknessOrATinyImage) {
  cv::Mat smoke(kSize, CV_8UC3);
  cv::randn(smoke, cv::Scalar(120, 120, 120), cv::Scalar(2, 2, 2));
  EXPECT_TRUE(find(smoke).empty());
  EXPECT_TRUE(find(cv::Mat(kSize, CV_8UC3, cv::Scalar(0, 0, 0))).empty());
  EXPECT_TRUE(find(cv::Mat(kSize, CV_8UC3, cv::Scalar(255, 255, 255))).empty());
  EXPECT_TRUE(find(cv::Mat(8, 8, CV_8UC3, cv::Scalar(90, 90, 90))).empty());
}

// A size that no estimate may have would take the place of one that may.
TEST_F(FeatureSearchTest, OffersNoSizeThatWouldBeRefused) {
  const cv::Mat nearer = seen(motion(1.6, 0.0, 0.0, {200.0, 210.0}));
  ASSERT_FALSE(find(nearer).empty());
  TrackerConfig config;
  config.quality.max_area_ratio = 1.5;
  search_ = FeatureSearch(config);
  EXPECT_TRUE(find(nearer).empty());
}

// What the alignment does not take for saturated, the search does not either.
TEST_F(FeatureSearchTest, SaturationIsThatOfTheAlignment) {
  cv::Mat bright;
  scene_.convertTo(bright, -1, 0.4, 150.0);
  const auto inliers = [&](int saturation) {
    TrackerConfig config;
    config.esm.saturation = saturation;
    search_ = FeatureSearch(config);
    views_.setReference(bright, kRoi, weights_);
    const std::vector<FeatureCandidate> found = find(bright);
    return found.empty() ? 0 : found[0].inliers;
  };
  EXPECT_GT(inliers(256), 30);
  EXPECT_EQ(inliers(155), 0) << "all of it is brighter";
}

TEST_F(FeatureSearchTest, WithoutAReferenceThereIsNoCandidate) {
  Keyframes none(4);
  EXPECT_TRUE(search_.find(scene_, image::kLuma, none).empty());
}

TEST_F(FeatureSearchTest, AViewThatCostsMoreThanTheBudgetIsDescribedStripByStrip) {
  const Eigen::Matrix3d g = motion(1.1, 0.4, 0.0, {250.0, 170.0});
  for (const double budget : {1.0, 0.005}) {
    TrackerConfig config;
    config.search.budget = budget;
    FeatureSearch search(config);
    views_.setReference(scene_, kRoi, weights_);
    const std::vector<FeatureCandidate> found = search.find(seen(g), image::kLuma, views_);
    ASSERT_TRUE(views_.at(0).described);
    EXPECT_EQ(views_.at(0).strips_described > 1, budget < 0.1);
    EXPECT_GT(views_.at(0).features.points.size(), 100u);
    ASSERT_FALSE(found.empty()) << budget;
    EXPECT_LT(geometry::cornerDistance(found[0].g, g, kRoi), 15.0) << budget;
  }
}

// What lies around the ROI moves with it; what covers it does not.
TEST_F(FeatureSearchTest, AViewGivesFeaturesAroundTheRegionButNoneWhereItWasOccluded) {
  weights_.setTo(0.0f);
  weights_(cv::Rect(65, 0, 65, 120)).setTo(1.0f);
  views_.setReference(scene_, kRoi, weights_);
  find(scene_);
  ASSERT_TRUE(views_.at(0).described);
  int inside = 0;
  int around = 0;
  for (const cv::Point2f& point : views_.at(0).features.points) {
    const bool rows = point.y >= kRoi.y + 2 && point.y <= kRoi.y + kRoi.height - 3;
    EXPECT_FALSE(rows && point.x >= kRoi.x + 2 && point.x <= kRoi.x + 62) << point;
    const bool in = rows && point.x >= kRoi.x && point.x < kRoi.x + kRoi.width;
    ++(in ? inside : around);
  }
  EXPECT_GE(inside, 10);
  EXPECT_GE(around, 10);
}

// A region of which nothing is seen itself is where its surroundings say.
TEST_F(FeatureSearchTest, FindsARegionByItsSurroundings) {
  const Eigen::Matrix3d g = motion(1.2, 0.6, 0.0, {230.0, 180.0});
  cv::Mat image = seen(g);
  std::vector<cv::Point> corners;
  for (const Eigen::Vector2d& corner : geometry::apply(g, kRoi.corners())) {
    corners.emplace_back(cvRound(corner.x()), cvRound(corner.y()));
  }
  cv::fillConvexPoly(image, corners, cv::Scalar(90, 90, 95));
  const std::vector<FeatureCandidate> found = find(image);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(geometry::cornerDistance(found[0].g, g, kRoi), 15.0);
}

TEST_F(FeatureSearchTest, APassInPiecesFindsTheSameAsAWholeOne) {
  const cv::Mat image = seen(motion(0.9, 0.7, 0.3, {250.0, 170.0}));
  const std::vector<FeatureCandidate> whole = find(image);
  search_.restart();
  const int scale = coarseScale(image.size(), SearchConfig().max_pixels);
  search_.begin(coarseImage(image, scale, image::kLuma, 250), image::kLuma, views_);
  int pieces = 0;
  while (search_.busy()) {
    EXPECT_GT(search_.nextCost(views_), 0.0);
    EXPECT_LT(search_.nextCost(views_), SearchConfig().budget);
    search_.work(views_);
    ++pieces;
  }
  EXPECT_GE(pieces, 3);
  const std::vector<FeatureCandidate> pieced = search_.found();
  ASSERT_FALSE(whole.empty());
  ASSERT_EQ(whole.size(), pieced.size());
  for (std::size_t k = 0; k < whole.size(); ++k) EXPECT_EQ(whole[k].g, pieced[k].g);
}

TEST_F(FeatureSearchTest, ViewsTakeTurnsAndAreDescribedWhenAsked) {
  for (const double zoom : {1.4, 2.0}) {
    const Eigen::Matrix3d g = motion(zoom, 0.0, 0.0, {240.0, 180.0});
    ASSERT_TRUE(views_.wants(g));
    views_.add(seen(g), g, weights_);
  }
  find(scene_);
  EXPECT_TRUE(views_.at(0).described);
  EXPECT_TRUE(views_.at(1).described);
  EXPECT_FALSE(views_.at(2).described);
  find(scene_);
  EXPECT_TRUE(views_.at(2).described);
}

// Tissue that has changed since.
TEST_F(FeatureSearchTest, AViewFindsWhatTheReferenceDoesNot) {
  const cv::Mat changed = test::tissue(kSize, 42);
  const Eigen::Matrix3d then = motion(1.4, 0.0, 0.0, {240.0, 180.0});
  const Eigen::Matrix3d now = motion(1.2, 0.3, 0.0, {230.0, 190.0});
  const cv::Mat image = test::view(changed, now, 0.9, 10.0, 2.0, 2);
  EXPECT_TRUE(find(image).empty());
  views_.add(test::view(changed, then, 1.0, 0.0, 2.0), then, weights_);
  search_.restart();
  const std::vector<FeatureCandidate> found = find(image);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(geometry::cornerDistance(found[0].g, now, kRoi), 15.0);
}

TEST_F(FeatureSearchTest, TheSameImageGivesTheSameCandidates) {
  const cv::Mat image = seen(motion(0.9, 0.7, 0.3, {250.0, 170.0}));
  const std::vector<FeatureCandidate> a = find(image);
  search_.restart();
  const std::vector<FeatureCandidate> b = find(image);
  ASSERT_FALSE(a.empty());
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].g, b[k].g);
    EXPECT_EQ(a[k].inliers, b[k].inliers);
  }
}

}  // namespace
}  // namespace laparoscope_servo::tracking
