// Films that stand still, begin again, or change: what the session makes of them.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "ros/tracker/image_conversion.h"
#include "ros/tracker/result_messages.h"
#include "ros/tracker/tracker_session.h"
#include "support/stamped_header.h"
#include "support/synthetic_sequence.h"

namespace laparoscope_servo {
namespace {

using test_support::at;
using tracking::State;

const cv::Size kSize(320, 240);
const geometry::Rectangle kRoi{100.0, 70.0, 100.0, 90.0};

sensor_msgs::CameraInfo cameraInfo() {
  sensor_msgs::CameraInfo info;
  info.K = {300.0, 0.0, 160.0, 0.0, 300.0, 120.0, 0.0, 0.0, 1.0};
  return info;
}

TrackerParameters withRoi() {
  TrackerParameters parameters;
  parameters.roi = kRoi;
  return parameters;
}

// A camera of 25 Hz, with the noise of a sensor.
class TrackerSessionInputTest : public testing::Test {
 protected:
  void SetUp() override {
    session_.setCameraInfo(cameraInfo());
    ASSERT_TRUE(show(moved(0.0)).result.selected_now);
  }

  cv::Mat noisy(const cv::Mat& picture) {
    cv::Mat noise(picture.size(), CV_16SC3);
    random_.fill(noise, cv::RNG::NORMAL, 0.0, 1.0);
    cv::Mat result;
    cv::add(picture, noise, result, cv::noArray(), CV_8U);
    return result;
  }
  // What the camera sees when the scope has moved by x px.
  cv::Mat moved(double x) {
    Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
    g(0, 2) = x;
    return noisy(test_support::view(scene_, g));
  }
  Processed show(const cv::Mat& picture) { return session_.process(picture, at(stamp_ += 0.04)); }
  State stateOf(const cv::Mat& picture) { return show(picture).result.state; }
  static double x(const Processed& processed) {
    return geometry::apply(processed.result.g, kRoi.centre()).x() - kRoi.centre().x();
  }
  void film(int images, double step = 0.0) {
    for (int k = 0; k < images; ++k) {
      const Processed processed = show(moved(x_ += step));
      ASSERT_EQ(processed.result.state, State::kTracking) << k << ": " << processed.result.reason;
      ASSERT_NEAR(x(processed), x_, 0.5);
    }
  }

  const cv::Mat scene_ = test_support::texture(kSize);
  cv::RNG random_{3};
  TrackerSession session_{withRoi()};
  double stamp_ = 100.0;
  double x_ = 0.0;
};

TEST_F(TrackerSessionInputTest, SaysWithinThreePicturesThatTheyRepeatAndGoesOnWithNewOnes) {
  film(5, 1.0);
  const cv::Mat last = moved(x_ += 1.0);
  EXPECT_TRUE(taskErrorMessage(show(last)).valid);
  show(last);
  for (int k = 2; k < 60; ++k) {
    const Processed frozen = show(last);
    ASSERT_EQ(frozen.result.state, State::kSearching) << k;
    ASSERT_FALSE(taskErrorMessage(frozen).valid) << k;
    ASSERT_NE(frozen.result.reason.find("the picture repeats: " + std::to_string(k) + " images"), std::string::npos)
        << frozen.result.reason;
  }
  show(moved(x_ += 1.0));
  film(5, 1.0);
}

TEST_F(TrackerSessionInputTest, NoticesAFrozenPictureBehindALiveBorderAndClock) {
  film(8, 1.0);
  const cv::Mat last = moved(x_);
  show(last);
  const cv::Rect inner(20, 20, 280, 200);
  for (int k = 1; k < 20; ++k) {
    cv::Mat picture = moved(x_);
    last(inner).copyTo(picture(inner));
    cv::putText(picture, std::to_string(k), cv::Point(25, 215), cv::FONT_HERSHEY_PLAIN, 1.0, cv::Scalar::all(255));
    const Processed processed = show(picture);
    if (k < 2) continue;
    ASSERT_FALSE(taskErrorMessage(processed).valid) << k;
    ASSERT_NE(processed.result.reason.find("within the region"), std::string::npos);
  }
}

// A still picture behind a live border could be a codec's; not when the robot has moved meanwhile.
TEST_F(TrackerSessionInputTest, BelievesTheRobotThatAPictureCannotStandStill) {
  double moved_by = 0.0;  // m
  session_.setCameraMotion(
      [&](const std::string&, const ros::Time&, const ros::Time&, std::string&) -> std::optional<Eigen::Isometry3d> {
        Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
        motion.translation().x() = moved_by;
        return motion;
      });
  film(5);
  const cv::Mat last = moved(0.0);
  show(last);
  const auto behindABorder = [&] {
    const cv::Rect inner(20, 20, 280, 200);
    cv::Mat picture = moved(0.0);
    last(inner).copyTo(picture(inner));
    return show(picture);
  };
  for (int k = 0; k < 6; ++k) EXPECT_EQ(behindABorder().result.state, State::kTracking) << k;
  moved_by = 0.08 * 3.0 / 300.0;  // 3 px at the depth of 0.08 m
  for (int k = 0; k < 3; ++k) EXPECT_FALSE(taskErrorMessage(behindABorder()).valid) << k;
}

TEST_F(TrackerSessionInputTest, NoticesOldPicturesThatComeInTurnAndAFieldThatStandsStill) {
  film(5, 0.5);
  const cv::Mat a = moved(x_ += 0.5);
  const cv::Mat b = moved(x_ += 0.5);
  show(a);
  show(b);
  show(a);
  for (int k = 0; k < 5; ++k) {
    EXPECT_NE(stateOf(k % 2 == 0 ? b : a), State::kTracking) << k;
  }
  for (int k = 0; k < 3; ++k) show(moved(x_));
  film(3);
  const cv::Mat field = moved(x_);
  show(field);
  for (int k = 1; k < 6; ++k) {
    cv::Mat woven = moved(x_);
    for (int row = 0; row < woven.rows; row += 2) field.row(row).copyTo(woven.row(row));
    const State state = stateOf(woven);
    if (k < 2) continue;
    EXPECT_NE(state, State::kTracking) << k;
  }
}

TEST_F(TrackerSessionInputTest, DropsSingleImagesOfAnotherTimeAndKeepsTheRegionWhereItIs) {
  film(30, 1.0);
  const cv::Mat old = moved(0.0);
  for (const double outlier : {stamp_ - 0.005, stamp_ - 1.0, stamp_ - 50.0, stamp_, stamp_ + 100.0, 0.0}) {
    EXPECT_THROW(session_.process(old, at(outlier)), ImageError) << outlier;
    film(2, 0.5);
  }
}

TEST_F(TrackerSessionInputTest, FindsTheRegionAgainInALoopAndClaimsNothingBefore) {
  film(40, 1.0);
  stamp_ = 100.0;
  x_ = 0.0;
  EXPECT_THROW(show(moved(0.0)), ImageError);
  EXPECT_THROW(show(moved(0.0)), ImageError);
  int images = 0;
  Processed processed;
  do {
    processed = show(moved(0.0));
    ASSERT_NE(processed.result.state, State::kIdle);
    if (processed.result.state != State::kTracking) continue;
    EXPECT_NEAR(x(processed), 0.0, 0.5);
  } while (processed.result.state != State::kTracking && ++images < 10);
  EXPECT_LT(images, 10);
  EXPECT_EQ(processed.reference_stamp, ros::Time(100.04)) << "it is the region that was selected";
  film(5, 1.0);
}

TEST_F(TrackerSessionInputTest, DoesNotSelectWhatLiesAtTheRoiOfAnotherFilm) {
  film(40, 1.0);
  stamp_ = 50.0;
  const cv::Mat other = test_support::texture(kSize, 77);
  session_.clockJumpedBack();
  for (int k = 0; k < 8; ++k) {
    const Processed processed = show(noisy(other));
    ASSERT_NE(processed.result.state, State::kTracking) << k;
    ASSERT_FALSE(processed.result.selected_now);
    ASSERT_FALSE(taskErrorMessage(processed).valid);
  }
}

TEST_F(TrackerSessionInputTest, GoesOnWhereTheClockTakesASmallStep) {
  film(30, 1.0);
  stamp_ -= 0.5;
  EXPECT_THROW(show(moved(x_)), ImageError);
  EXPECT_THROW(show(moved(x_)), ImageError);
  film(10, 1.0);
}

TEST_F(TrackerSessionInputTest, RefusesOddImagesAndKeepsTheRegion) {
  film(5, 1.0);
  cv::Mat half;
  cv::resize(scene_, half, cv::Size(), 0.5, 0.5);
  cv::Mat grey;
  cv::cvtColor(scene_, grey, cv::COLOR_BGR2GRAY);
  for (const cv::Mat& odd : {cv::Mat(1, 1, CV_8UC3, cv::Scalar(1, 2, 3)), half, grey}) {
    EXPECT_THROW(session_.process(odd, at(stamp_ + 0.01)), ImageError);
    film(2, 0.5);
  }
}

TEST_F(TrackerSessionInputTest, TakesASizeThatLastsForAnotherCameraAndFindsTheRegionWhenTheOldOneIsBack) {
  film(5, 1.0);
  cv::Mat half;
  cv::resize(scene_, half, cv::Size(), 0.5, 0.5);
  EXPECT_THROW(show(noisy(half)), ImageError);
  EXPECT_THROW(show(noisy(half)), ImageError);
  const Processed processed = show(noisy(half));
  EXPECT_EQ(processed.result.state, State::kIdle);
  EXPECT_NE(processed.result.reason.find("size changed from 320 x 240 to 160 x 120 px: select"), std::string::npos)
      << processed.result.reason;
  EXPECT_EQ(session_.occlusionMask().size(), half.size());
  EXPECT_EQ(stateOf(noisy(half)), State::kIdle) << "the ROI of the parameters is one of the other camera";
  EXPECT_THROW(show(moved(x_)), ImageError);
  EXPECT_THROW(show(moved(x_)), ImageError);
  EXPECT_EQ(stateOf(moved(x_)), State::kSearching);
  for (int k = 0; k < 10 && stateOf(moved(x_)) != State::kTracking; ++k) continue;
  film(3, 1.0);
}

TEST_F(TrackerSessionInputTest, ClaimsNothingWrongWhereColourIsGoneForGood) {
  film(5, 1.0);
  cv::Mat grey;
  for (int k = 0; k < 8; ++k) {
    cv::cvtColor(moved(x_), grey, cv::COLOR_BGR2GRAY);
    if (k < 2) {
      EXPECT_THROW(show(grey), ImageError);
      continue;
    }
    const Processed processed = show(grey);
    if (processed.result.state != State::kTracking) continue;
    EXPECT_NEAR(x(processed), x_, 0.5) << k;
  }
}

TEST_F(TrackerSessionInputTest, ClaimsNothingOfPicturesThatShowNothing) {
  film(5, 1.0);
  const cv::Mat black = cv::Mat::zeros(kSize, CV_8UC3);
  const cv::Mat white(kSize, CV_8UC3, cv::Scalar::all(255));
  for (int k = 0; k < 6; ++k) {  // flickering light
    EXPECT_NE(stateOf(noisy(k % 2 == 0 ? black : white)), State::kTracking) << k;
  }
  cv::Mat mirrored;
  cv::flip(scene_, mirrored, 1);
  for (int k = 0; k < 6; ++k) EXPECT_NE(stateOf(noisy(mirrored)), State::kTracking) << k;
  cv::flip(scene_, mirrored, 0);
  for (int k = 0; k < 6; ++k) EXPECT_NE(stateOf(noisy(mirrored)), State::kTracking) << k;
}

// The region is in a picture that is turned over, but the scope cannot have turned as fast.
TEST_F(TrackerSessionInputTest, HoldsBackWhatIsFoundUpsideDown) {
  film(5);
  cv::Mat turned;
  cv::flip(scene_, turned, -1);
  bool said = false;
  for (int k = 0; k < 8; ++k) {
    const Processed processed = show(noisy(turned));
    EXPECT_NE(processed.result.state, State::kTracking) << k;
    EXPECT_FALSE(taskErrorMessage(processed).valid);
    said = said || processed.result.reason.find("turned by 180 degrees") != std::string::npos ||
           processed.result.reason.find("turned by -180 degrees") != std::string::npos;
  }
  EXPECT_TRUE(said);
  int images = 0;  // until the picture that stands upright again is believed: a second at most
  while (show(moved(x_)).result.state != State::kTracking) ASSERT_LT(++images, 25);
  film(3, 1.0);
}

TEST_F(TrackerSessionInputTest, FindsOutHowManyBitsAreUsed) {
  cv::Mat twelve;
  scene_.convertTo(twelve, CV_16UC3, 4095.0 / 255.0);
  TrackerSession session(withRoi());
  const Processed processed = session.process(twelve, at(1.0));
  EXPECT_EQ(processed.result.state, State::kTracking);
  EXPECT_LE(cv::norm(processed.image, scene_, cv::NORM_INF), 1.0);
  TrackerParameters told = withRoi();
  told.image.bit_depth = 16;
  EXPECT_LT(cv::mean(TrackerSession(told).process(twelve, at(1.0)).image)[2], 20.0);
}

TEST(TrackerSessionInput, RefusesParametersOutOfRange) {
  TrackerParameters parameters;
  parameters.input.restart_images = 0;
  EXPECT_THROW(TrackerSession{parameters}, std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo
