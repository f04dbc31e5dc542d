// Regions across the border of a round picture: it stands still in the image, whatever the tissue does.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "laparoscope_servo/tracking/region_tracker.h"
#include "support/error_text.h"
#include "support/synthetic_sequence.h"

namespace laparoscope_servo::tracking {
namespace {

const cv::Size kSize(640, 480);
constexpr int kRadius = 250;

class RegionTrackerBorder : public testing::Test {
 protected:
  // The tissue, moved by (x, y) px, as an endoscope shows it.
  cv::Mat picture(double x, double y) { return picture(tissue_, kRadius, x, y); }
  cv::Mat picture(const cv::Mat& scene, int radius, double x, double y) {
    const cv::Mat tissue = test_support::view(scene, (Eigen::Matrix3d() << 1, 0, x, 0, 1, y, 0, 0, 1).finished());
    cv::Mat field = cv::Mat::zeros(scene.size(), CV_8UC1), image = cv::Mat::zeros(scene.size(), CV_8UC3);
    cv::circle(field, {scene.cols / 2, scene.rows / 2}, radius, 255, cv::FILLED, cv::LINE_8);
    tissue.copyTo(image, field);
    return test_support::noisy(image, random_);
  }
  std::string refusal(const geometry::Rectangle& roi) {
    return test_support::errorText<std::invalid_argument>([&] { tracker_.select(picture(0, 0), 0.0, roi); });
  }

  cv::RNG random_{3};
  // Low contrast, as on a smooth organ: beside it the border is the strongest edge by far.
  const cv::Mat tissue_ = [] {
    cv::Mat image = test_support::texture(kSize);
    image = 0.35 * image + cv::Scalar(40, 45, 70);
    return image;
  }();
  RegionTracker tracker_{TrackerConfig()};
};

TEST_F(RegionTrackerBorder, FollowsTheTissueAndNotTheBorder) {
  const geometry::Rectangle roi{35, 180, 110, 120};  // the picture begins at x = 70 in its middle: a third is black
  tracker_.select(picture(0, 0), 0.0, roi);
  for (int k = 1; k <= 30; ++k) {
    const double x = 0.8 * k, y = -0.4 * k;
    const TrackResult& result = tracker_.track(picture(x, y), 0.04 * k);
    ASSERT_EQ(result.state, State::kTracking) << "image " << k << ": " << result.reason;
    const Eigen::Vector2d seen = geometry::apply(result.g, Eigen::Vector2d(110, 240));
    ASSERT_LT((seen - Eigen::Vector2d(110 + x, 240 + y)).norm(), 0.5) << "image " << k;
  }
}

// In a small picture each piece of a region across the border holds some of it: pieces that were found at the border
// vouched for estimates that were 2.3 and 4.7 px off.
TEST_F(RegionTrackerBorder, PiecesOfTheRegionAreThoseOfTheTissue) {
  const geometry::Rectangle roi{40, 90, 62, 107};
  for (const int seed : {1, 2}) {
    const cv::Mat scene = 0.25 * test_support::texture({320, 256}, seed) + cv::Scalar(60, 60, 60);
    random_ = cv::RNG(3);
    tracker_.select(picture(scene, 118, 0, 0), 0.0, roi);
    int tracked = 0;
    for (int k = 1; k <= 30; ++k) {
      const double x = -1.0 * k, y = 0.7 * k;
      const TrackResult& result = tracker_.track(picture(scene, 118, x, y), 0.04 * k);
      if (result.state != State::kTracking) continue;
      ++tracked;
      const Eigen::Vector2d seen = geometry::apply(result.g, roi.centre());
      EXPECT_LT((seen - roi.centre() - Eigen::Vector2d(x, y)).norm(), 1.9) << "seed " << seed << ", image " << k;
    }
    EXPECT_GE(tracked, 20) << "seed " << seed;
  }
}

TEST_F(RegionTrackerBorder, ARegionMostlyOnTheBlackIsRefused) {
  EXPECT_NE(refusal({0, 180, 100, 120}).find("lies beyond the picture's border, where it is black, by 7"),
            std::string::npos)
      << refusal({0, 180, 100, 120});
  EXPECT_FALSE(tracker_.hasRoi());
  EXPECT_EQ(refusal({270, 190, 100, 100}), "");
}

TEST_F(RegionTrackerBorder, ARegionThatLeavesThePictureIsNotClaimedAtItsBorder) {
  tracker_.select(picture(0, 0), 0.0, {100, 180, 100, 100});
  for (int k = 1; k <= 60; ++k) {
    const double x = -4.0 * k;
    const TrackResult& result = tracker_.track(picture(x, 0), 0.04 * k);
    if (result.state != State::kTracking) continue;
    const Eigen::Vector2d seen = geometry::apply(result.g, Eigen::Vector2d(150, 230));
    ASSERT_LT((seen - Eigen::Vector2d(150 + x, 230)).norm(), 3.0) << "image " << k;
  }
  EXPECT_NE(tracker_.track(picture(-244, 0), 2.44).state, State::kTracking);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
