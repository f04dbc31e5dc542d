#include "ros/features/feature_overlay.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo {
namespace {

using features::State;

const cv::Vec3b kRed(0, 0, 255), kYellow(0, 255, 255), kGrey(90, 90, 90);

// Edges are smoothed.
bool isLike(const cv::Vec3b& a, const cv::Vec3b& b) {
  return cv::norm(a, b, cv::NORM_INF) < 40.0;
}

// A horizontal line through the middle.
features::TrackedFeatures lineIn(State state) {
  features::TrackedFeatures tracked;
  tracked.features.resize(1);
  tracked.features[0].id = "shaft";
  tracked.features[0].state = state;
  tracked.features[0].outline = {{100.0, 120.0}, {300.0, 120.0}};
  features::summarise(tracked, "");
  return tracked;
}

TEST(FeatureOverlay, DrawsWhatIsSeenAndWhatIsSearched) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    const cv::Mat image(240, 400, type, cv::Scalar::all(90));
    EXPECT_TRUE(isLike(drawFeatures(image, lineIn(State::kTracking)).at<cv::Vec3b>(120, 250), kRed));
    EXPECT_TRUE(isLike(drawFeatures(image, lineIn(State::kSearching)).at<cv::Vec3b>(120, 250), kYellow));
    EXPECT_EQ(drawFeatures(image, lineIn(State::kLost)).at<cv::Vec3b>(120, 250), kGrey);
    EXPECT_EQ(cv::countNonZero(image.reshape(1) != 90), 0) << "the image itself was drawn on";
  }
}

// Three pieces of a line: believed, half believed, astray.
TEST(FeatureOverlay, DrawsSitesWithTheirWeights) {
  const cv::Mat image(240, 400, CV_8UC1, cv::Scalar(90));
  features::TrackedFeatures tracked = lineIn(State::kTracking);
  for (int u = 110; u <= 290; u += 3)
    tracked.features[0].sites.push_back({{u, 120.0}, u < 170 ? 1.0 : u < 230 ? 0.3 : 0.0});
  const cv::Mat drawn = drawFeatures(image, tracked);
  const auto count = [&](int from, const cv::Vec3b& colour) {
    int pixels = 0;
    for (int v = 110; v < 130; ++v) {
      for (int u = from; u < from + 55; ++u) pixels += isLike(drawn.at<cv::Vec3b>(v, u), colour) ? 1 : 0;
    }
    return pixels;
  };
  const cv::Vec3b green(80, 255, 80), white(255, 255, 255);
  EXPECT_GT(count(112, green), 2 * count(173, green)) << "a larger weight is a larger dot";
  EXPECT_GT(count(173, green), 10);
  EXPECT_EQ(count(234, green), 0);
  EXPECT_GT(count(234, white), 10) << "what is astray is a cross";
  EXPECT_EQ(count(112, white) + count(173, white), 0);
  tracked.features[0].sites = {{{std::numeric_limits<double>::quiet_NaN(), 120.0}, 1.0}, {{1e9, 0.0}, 0.0}};
  EXPECT_EQ(cv::norm(drawFeatures(image, tracked), drawFeatures(image, lineIn(State::kTracking)), cv::NORM_INF), 0.0);
}

TEST(FeatureOverlay, WritesTheState) {
  const cv::Mat image(240, 400, CV_8UC1, cv::Scalar(90));
  features::TrackedFeatures none;
  features::summarise(none, "nothing is selected");
  const cv::Mat drawn = drawFeatures(image, none);
  EXPECT_GT(cv::countNonZero(drawn.rowRange(0, 30).reshape(1) > 180), 50);
  EXPECT_EQ(cv::countNonZero(drawn.rowRange(60, 240).reshape(1) != 90), 0);
}

TEST(FeatureOverlay, DrawsACentreAndNothingThatIsNowhere) {
  const cv::Mat image(240, 400, CV_8UC1, cv::Scalar(90));
  features::TrackedFeatures tracked = lineIn(State::kTracking);
  tracked.features[0].outline = {{200.0, 120.0}};
  EXPECT_GT(cv::countNonZero(drawFeatures(image, tracked)(cv::Rect(185, 105, 30, 30)).reshape(1) > 180), 5);
  for (const double far : {1e9, std::numeric_limits<double>::quiet_NaN()}) {
    tracked.features[0].outline = {{200.0, 120.0}, {far, 120.0}};
    EXPECT_EQ(drawFeatures(image, tracked).at<cv::Vec3b>(120, 250), kGrey);
  }
}

// A shift of 4 px to the right: arrows of 20 px. Half of the image does not follow.
TEST(FeatureOverlay, DrawsAFieldOverWhatDoesNotFollow) {
  const cv::Mat image(240, 400, CV_8UC1, cv::Scalar(90));
  features::TrackedFeatures tracked = lineIn(State::kTracking);
  tracked.features[0].kind = features::FeatureKind::kMotion;
  tracked.features[0].parameters = Eigen::Vector2d(4.0, 0.0);
  cv::Mat mask = cv::Mat::zeros(240, 400, CV_8UC1);
  mask.colRange(200, 400).setTo(255);
  const cv::Mat drawn = drawFeatures(image, tracked, mask);
  const double first = 0.5 * 400.0 / 12.0;
  const int row = static_cast<int>(std::lround(first + 400.0 / 12.0 * 2.0));
  EXPECT_TRUE(isLike(drawn.at<cv::Vec3b>(row, static_cast<int>(first) + 10), kRed));
  EXPECT_EQ(drawn.at<cv::Vec3b>(60, 60), kGrey);
  EXPECT_TRUE(isLike(drawn.at<cv::Vec3b>(110, 380), cv::Vec3b(172, 45, 45))) << drawn.at<cv::Vec3b>(110, 380);
  tracked.features[0].kind = features::FeatureKind::kLine;
  EXPECT_EQ(drawFeatures(image, tracked, mask).at<cv::Vec3b>(100, 390), kGrey);
}

}  // namespace
}  // namespace laparoscope_servo
