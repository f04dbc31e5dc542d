#include "ros/tracker/overlay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace laparoscope_servo {
namespace {

const cv::Vec3b kRed(0, 0, 255);
const cv::Vec3b kBlue(255, 0, 0);
const cv::Vec3b kGrey(100, 100, 100);

// ROI of 40 x 40 at (100, 100), now 60 px further right; 2 x 2 areas, the bottom left one occluded.
tracking::TrackResult tracked() {
  tracking::TrackResult result;
  result.state = tracking::State::kTracking;
  result.roi = {100.0, 100.0, 40.0, 40.0};
  result.g(0, 2) = 60.0;
  result.visible_fraction = 0.75;
  result.areas = {2, 2, {0.0f, 0.0f, 0.9f, 0.0f}, {false, false, true, false}, {}};
  return result;
}

cv::Mat image() {
  return cv::Mat(240, 320, CV_8UC3, cv::Scalar(100, 100, 100));
}

TEST(Overlay, DrawsReferenceBlueAndCurrentRed) {
  const cv::Mat picture = drawOverlay(image(), tracked());
  EXPECT_EQ(picture.at<cv::Vec3b>(100, 120), kBlue);
  EXPECT_EQ(picture.at<cv::Vec3b>(139, 120), kBlue);
  EXPECT_EQ(picture.at<cv::Vec3b>(120, 100), kBlue);
  EXPECT_EQ(picture.at<cv::Vec3b>(120, 139), kBlue);
  EXPECT_EQ(picture.at<cv::Vec3b>(100, 180), kRed);
  EXPECT_EQ(picture.at<cv::Vec3b>(139, 190), kRed);
  EXPECT_EQ(picture.at<cv::Vec3b>(110, 160), kRed);
  EXPECT_EQ(picture.at<cv::Vec3b>(110, 199), kRed);
}

TEST(Overlay, FillsOccludedAreasWhereTheyAreNow) {
  const cv::Mat picture = drawOverlay(image(), tracked());
  const cv::Vec3b filled = picture.at<cv::Vec3b>(130, 170);
  EXPECT_GT(filled[0], 150);
  EXPECT_LT(filled[2], 80);
  EXPECT_EQ(picture.at<cv::Vec3b>(110, 170), kGrey);  // top left
  EXPECT_EQ(picture.at<cv::Vec3b>(130, 190), kGrey);  // bottom right
  EXPECT_EQ(picture.at<cv::Vec3b>(130, 110), kGrey);  // in the reference
}

TEST(Overlay, LeavesTheImageAlone) {
  const cv::Mat original = image();
  drawOverlay(original, tracked());
  EXPECT_EQ(cv::norm(original, image(), cv::NORM_INF), 0.0);
}

TEST(Overlay, WritesTheState) {
  tracking::TrackResult idle;
  const cv::Mat picture = drawOverlay(image(), idle);
  EXPECT_GT(cv::norm(picture, image(), cv::NORM_INF), 100.0);
  cv::Mat below = picture.rowRange(60, 240);
  EXPECT_EQ(cv::norm(below, image().rowRange(60, 240), cv::NORM_INF), 0.0);
}

TEST(Overlay, ShowsNoCurrentRegionWhenItIsLost) {
  tracking::TrackResult lost = tracked();
  lost.state = tracking::State::kLost;
  const cv::Mat picture = drawOverlay(image(), lost);
  EXPECT_EQ(picture.at<cv::Vec3b>(100, 180), kGrey);
  EXPECT_EQ(picture.at<cv::Vec3b>(130, 170), kGrey);
  EXPECT_EQ(picture.at<cv::Vec3b>(100, 120), kBlue);
}

TEST(Overlay, TakesGreyImages) {
  const cv::Mat picture = drawOverlay(cv::Mat(240, 320, CV_8UC1, cv::Scalar(100)), tracked());
  ASSERT_EQ(picture.type(), CV_8UC3);
  EXPECT_EQ(picture.at<cv::Vec3b>(200, 20), kGrey);
  EXPECT_EQ(picture.at<cv::Vec3b>(100, 180), kRed);
}

TEST(Overlay, BearsHomographiesThatCannotBeDrawn) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), 1e300, -1e12}) {
    tracking::TrackResult result = tracked();
    result.g(0, 2) = bad;
    const cv::Mat picture = drawOverlay(image(), result);
    EXPECT_EQ(picture.at<cv::Vec3b>(100, 120), kBlue);
  }
  tracking::TrackResult through_infinity = tracked();
  through_infinity.g(2, 0) = -1.0 / 120.0;  // the ROI's middle goes to infinity
  EXPECT_EQ(drawOverlay(image(), through_infinity).at<cv::Vec3b>(139, 120), kBlue);
  tracking::TrackResult short_report = tracked();
  short_report.areas.occluded.clear();
  EXPECT_EQ(drawOverlay(image(), short_report).at<cv::Vec3b>(130, 170), kGrey);
}

TEST(Overlay, BendsTheEdgesAsTheLensDoes) {
  image::LensParameters parameters;
  parameters.coefficients = {-0.3};
  parameters.raw = parameters.rectified = {200.0, 200.0, 160.0, 120.0};
  const image::Lens lens(parameters);
  tracking::TrackResult result = tracked();
  result.roi = {40.0, 20.0, 241.0, 201.0};
  result.g.setIdentity();
  const cv::Mat picture = drawOverlay(image(), result, &lens);
  const auto at = [&](double u, double v) {
    const auto raw = lens.toRaw({u, v});
    return raw ? picture.at<cv::Vec3b>(static_cast<int>(std::lround(raw->y())), static_cast<int>(std::lround(raw->x())))
               : cv::Vec3b();
  };
  EXPECT_EQ(at(280.0, 120.0), kRed) << "the right edge's middle";
  EXPECT_EQ(at(280.0, 70.0), kRed);
  EXPECT_EQ(at(280.0, 40.0), kRed);
  EXPECT_NE(picture.at<cv::Vec3b>(70, 280), kRed) << "where it would be without the lens";
  EXPECT_GT(at(100.0, 180.0)[0], 150) << "the occluded area";
  EXPECT_EQ(at(200.0, 180.0), kGrey);
  result.g(0, 2) = 1e6;
  EXPECT_EQ(drawOverlay(image(), result, &lens).size(), image().size());
}

TEST(Overlay, BearsATinyImage) {
  EXPECT_EQ(drawOverlay(cv::Mat(1, 1, CV_8UC3), tracked()).size(), cv::Size(1, 1));
}

}  // namespace
}  // namespace laparoscope_servo
