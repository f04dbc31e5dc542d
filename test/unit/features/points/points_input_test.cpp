// What is wrong with images, selections and parameters of points is named, and tracking goes on.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "laparoscope_servo/features/points.h"
#include "points_check.h"

namespace laparoscope_servo::features {
namespace {

TEST_F(PointsTest, EndWithTheReasonWhenTimeOrImagesChange) {
  select();
  EXPECT_EQ(tracker_.track(image(Eigen::Matrix3d::Identity()), -1.0).reason, Reason::kTimeJumpedBack);
  EXPECT_TRUE(tracker_.result().points.empty());
  select();
  EXPECT_EQ(tracker_.track(cv::Mat(kSize, CV_8UC1, cv::Scalar(90)), 1.0).reason, Reason::kImageChanged);
  select();
  EXPECT_EQ(tracker_.track(cv::Mat(100, 100, CV_8UC3), 1.0).reason, Reason::kImageChanged);
  EXPECT_EQ(tracker_.track(image(Eigen::Matrix3d::Identity()), 2.0).reason, Reason::kImageChanged);
  tracker_.reset();
  EXPECT_EQ(tracker_.result().reason, Reason::kReset);
}

TEST_F(PointsTest, RefuseByNameAndGoOn) {
  select();
  const cv::Mat flat(kSize, CV_8UC3, cv::Scalar(60, 70, 110)), now = image(Eigen::Matrix3d::Identity());
  const auto refusal = [&](const cv::Mat& picture, const std::vector<PointGroup>& groups, double stamp = kPeriod) {
    try {
      tracker_.select(picture, stamp, groups);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const double nan = std::nan("");
  EXPECT_NE(refusal(flat, {{cv::Mat(), {{100.0, 90.0}}}}).find("point at (100, 90), expected texture"),
            std::string::npos);
  EXPECT_NE(refusal(now, {{cv::Mat(), {{5.0, 90.0}}}}).find("expected a window of 21 px"), std::string::npos);
  EXPECT_NE(refusal(now, {{cv::Mat(), {{nan, 90.0}}}}).find("nan"), std::string::npos);
  EXPECT_NE(refusal(now, {{cv::Mat(), {{1000.0, 90.0}}}}).find("(1000, 90)"), std::string::npos);
  EXPECT_NE(refusal(now, {{cv::Mat(), {corners_[0], corners_[0]}}}).find("no other point"), std::string::npos);
  EXPECT_EQ(refusal(now, {}), "0 points, expected at least 1");
  EXPECT_NE(refusal(cv::Mat(), {{cv::Mat(), corners_}}).find("0 x 0 px"), std::string::npos);
  EXPECT_NE(refusal(now, {{cv::Mat(), corners_}}, nan).find("stamp"), std::string::npos);
  EXPECT_NE(refusal(test::tissue(kSize, 50), {{now, corners_}}).find("expected one that the image shows"),
            std::string::npos);
  EXPECT_NE(refusal(now, {{cv::Mat(kSize, CV_16UC1), corners_}}).find("8 bit"), std::string::npos);
  EXPECT_EQ(track(image(motion({1.0, 0.0}))).state, State::kTracking);
  EXPECT_THROW(tracker_.track(cv::Mat(kSize, CV_32FC1), 1.0), std::invalid_argument);
  EXPECT_EQ(track(image(motion({2.0, 0.0}))).state, State::kTracking);
  // A motion that is none is ignored.
  Eigen::Matrix3d broken = Eigen::Matrix3d::Constant(nan);
  EXPECT_EQ(tracker_.track(image(motion({3.0, 0.0})), time_ + 0.01, broken).state, State::kTracking);
  EXPECT_EQ(tracker_.track(image(motion({4.0, 0.0})), time_ + 0.02, Eigen::Matrix3d::Zero()).state, State::kTracking);
}

TEST(PointsConfigTest, NamesEveryError) {
  EXPECT_TRUE(validate(PointsConfig()).empty());
  PointsConfig config;
  config.window = 20;
  config.max_error = std::nan("");
  config.levels = 0;
  const std::vector<std::string> errors = validate(config);
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_THROW(PointTracker{config}, std::invalid_argument);
  EXPECT_EQ(errors.back(), "window = 20, expected an odd number");
}

}  // namespace
}  // namespace laparoscope_servo::features
