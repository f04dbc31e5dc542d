#include "ros/tracker/preview.h"

#include <gtest/gtest.h>

#include "support/synthetic_lens.h"

namespace laparoscope_servo {
namespace {

TEST(Preview, IsNoLargerThanItsBoundsAndKeepsTheShape) {
  const struct {
    cv::Size image, preview;
  } cases[] = {{{1920, 1080}, {640, 360}}, {{3840, 2160}, {640, 360}}, {{720, 576}, {640, 512}},
               {{640, 480}, {640, 480}},   {{320, 240}, {320, 240}},   {{1080, 1920}, {360, 640}},
               {{1, 1}, {1, 1}},           {{5000, 1}, {640, 1}}};
  for (const auto& each : cases) {
    for (const int type : {CV_8UC1, CV_8UC3}) {
      const cv::Mat preview = Preview().of(cv::Mat(each.image, type, cv::Scalar::all(90)), nullptr);
      EXPECT_EQ(preview.size(), each.preview) << each.image;
      EXPECT_EQ(preview.type(), type);
      EXPECT_EQ(preview.data[0], 90);
    }
  }
}

TEST(Preview, ShowsEachPixelAtItsPlace) {
  cv::Mat image(1080, 1920, CV_8UC1, cv::Scalar(0));
  image(cv::Rect(960, 300, 30, 30)).setTo(255);
  const cv::Mat preview = Preview().of(image, nullptr);
  EXPECT_EQ(preview.at<std::uint8_t>(100, 320), 255);
  EXPECT_EQ(preview.at<std::uint8_t>(109, 329), 255);
  EXPECT_EQ(preview.at<std::uint8_t>(99, 320), 0);
  EXPECT_EQ(preview.at<std::uint8_t>(100, 330), 0);
}

TEST(Preview, RateIsBoundedAndTheRhythmKept) {
  const auto shown = [](double rate) {
    Preview preview;
    int count = 0;
    for (int k = 0; k < 10 * rate; ++k) count += preview.due(1000.0 + k / rate + 1e-6) ? 1 : 0;
    return count;
  };
  EXPECT_EQ(shown(10.0), 100);
  EXPECT_EQ(shown(25.0), 250);
  EXPECT_NEAR(shown(30.0), 250, 2);
  EXPECT_NEAR(shown(60.0), 250, 2);
}

// A bright square of the raw image appears where the lens' rectified pixels have it.
TEST(Preview, IsRectifiedWhereTheTrackerIs) {
  const cv::Size size(1280, 960);
  image::LensParameters parameters;
  parameters.coefficients = {-0.3, 0.1};
  parameters.raw = parameters.rectified = {900.0, 900.0, 639.5, 479.5};
  const auto lens = std::make_shared<const image::Lens>(parameters);
  const Eigen::Vector2d rectified(200.0, 150.0);
  const auto raw = lens->toRaw(rectified);
  ASSERT_TRUE(raw);
  ASSERT_GT((*raw - rectified).norm(), 30.0) << "a lens that does something";
  cv::Mat image(size, CV_8UC1, cv::Scalar(0));
  cv::circle(image, cv::Point(static_cast<int>(raw->x()), static_cast<int>(raw->y())), 10, cv::Scalar(255), cv::FILLED);
  Preview preview;
  for (int k = 0; k < 2; ++k) {
    const cv::Mat shown = preview.of(image, lens);
    EXPECT_EQ(shown.at<std::uint8_t>(75, 100), 255);
    EXPECT_EQ(shown.at<std::uint8_t>(static_cast<int>(raw->y() / 2), static_cast<int>(raw->x() / 2)), 0);
  }
  EXPECT_EQ(preview.of(image, nullptr).at<std::uint8_t>(75, 100), 0) << "and not where it is not";
}

}  // namespace
}  // namespace laparoscope_servo
