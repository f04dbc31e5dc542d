// Images, stamps, masks and regions that cannot be used are refused by name, and tracking goes on.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "laparoscope_servo/motion/dominant_motion.h"
#include "support/synthetic_motion.h"

namespace laparoscope_servo::motion {
namespace {

using features::Reason;
using features::State;
using test::movingTissue;
using test::usualMotion;

class DominantMotionInput : public testing::Test {
 protected:
  void SetUp() override {
    for (; k_ < 2; ++k_) motion_.track(movingTissue(k_, field_), 0.04 * k_);
    ASSERT_EQ(motion_.result().state, State::kTracking);
  }
  template <class Call>
  void expectRefused(const Call& call, const std::string& part) {
    try {
      call();
      FAIL() << "expected: " << part;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
    EXPECT_EQ(motion_.track(movingTissue(k_, field_), 0.04 * k_).state, State::kTracking);
    ++k_;
  }

  MotionField field_ = usualMotion();
  DominantMotion motion_;
  int k_ = 0;
};

TEST_F(DominantMotionInput, RefusesWhatItCannotUse) {
  expectRefused([&] { motion_.track(cv::Mat(), 1.0); }, "px");
  expectRefused([&] { motion_.track(cv::Mat(240, 320, CV_32FC1, cv::Scalar(1)), 1.0); }, "OpenCV type 5");
  expectRefused([&] { motion_.track(cv::Mat(40, 320, CV_8UC1, cv::Scalar(1)), 1.0); }, "image of 320 x 40 px");
  expectRefused([&] { motion_.track(movingTissue(3, field_), std::numeric_limits<double>::quiet_NaN()); }, "stamp");
  const cv::Mat small = cv::Mat::zeros(100, 100, CV_8UC1);
  expectRefused([&] { motion_.track(movingTissue(3, field_), 1.0, std::nullopt, small); },
                "external mask of 100 x 100");
  expectRefused(
      [&] {
        motion_.begin(movingTissue(3, field_), 1.0, geometry::Rectangle{0.0, 0.0, 20.0, 100.0});
      },
      "region of 20 x 100 px");
  expectRefused(
      [&] {
        motion_.begin(movingTissue(3, field_), 1.0, geometry::Rectangle{280.0, 0.0, 60.0, 60.0});
      },
      "within the image of 320 x 240");
  expectRefused(
      [&] {
        motion_.begin(movingTissue(3, field_), 1.0,
                      geometry::Rectangle{0.0, 0.0, std::numeric_limits<double>::quiet_NaN(), 60.0});
      },
      "region of");
}

TEST_F(DominantMotionInput, IgnoresAMotionThatIsNone) {
  Eigen::Matrix3d wrong = Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(motion_.track(movingTissue(2, field_), 0.08, wrong).state, State::kTracking);
  EXPECT_EQ(motion_.track(movingTissue(3, field_), 0.12, Eigen::Matrix3d(Eigen::Matrix3d::Zero())).state,
            State::kTracking);
  const double infinite = std::numeric_limits<double>::infinity();
  int k = 4;
  for (const double each : {infinite, -infinite, 1e5, 1e200}) {
    wrong.setIdentity();
    wrong.topLeftCorner<2, 2>() *= each;
    const MotionResult& result = motion_.track(movingTissue(k, field_), 0.04 * k, wrong);
    EXPECT_EQ(result.state, State::kTracking) << each;
    EXPECT_TRUE(result.g.allFinite() && result.field.a.allFinite() && result.covariance.allFinite()) << each;
    ++k;
  }
}

TEST_F(DominantMotionInput, BeginsAnewWhenTimeJumpsBack) {
  EXPECT_EQ(motion_.track(movingTissue(2, field_), 0.01).state, State::kIdle);
  EXPECT_EQ(motion_.result().reason, Reason::kTimeJumpedBack);
  EXPECT_EQ(motion_.track(movingTissue(3, field_), 0.05).state, State::kTracking);
}

TEST_F(DominantMotionInput, BeginsAnewWithAnotherSizeOrType) {
  const auto half = [&](int k) { return movingTissue(k, field_)(cv::Rect(0, 0, 200, 200)).clone(); };
  EXPECT_EQ(motion_.track(half(2), 0.08).state, State::kIdle);
  EXPECT_EQ(motion_.result().reason, Reason::kImageChanged);
  EXPECT_EQ(motion_.track(half(3), 0.12).state, State::kTracking);
  cv::Mat grey;
  cv::cvtColor(half(4), grey, cv::COLOR_BGR2GRAY);
  EXPECT_EQ(motion_.track(grey, 0.16).state, State::kIdle);
  cv::cvtColor(half(5), grey, cv::COLOR_BGR2GRAY);
  EXPECT_EQ(motion_.track(grey, 0.2).state, State::kTracking);
}

TEST_F(DominantMotionInput, NamesTheImageWhereTimeJumpsBackAsWell) {
  EXPECT_EQ(motion_.track(movingTissue(2, field_)(cv::Rect(0, 0, 200, 200)), 0.01).state, State::kIdle);
  EXPECT_EQ(motion_.result().reason, Reason::kImageChanged);
}

// Two images at one time have a motion between them, but no velocity.
TEST_F(DominantMotionInput, BearsAStampThatRepeats) {
  EXPECT_EQ(motion_.track(movingTissue(2, field_), 0.04).state, State::kTracking);
  EXPECT_EQ(motion_.track(movingTissue(3, field_), 0.08).state, State::kTracking);
}

TEST_F(DominantMotionInput, ForgetsAllWhenItIsReset) {
  motion_.reset();
  EXPECT_EQ(motion_.result().state, State::kIdle);
  EXPECT_EQ(motion_.result().reason, Reason::kReset);
  EXPECT_EQ(motion_.track(movingTissue(2, field_), 0.08).state, State::kIdle);
  EXPECT_EQ(motion_.track(movingTissue(3, field_), 0.12).state, State::kTracking);
}

TEST(DominantMotion, RefusesAWrongConfiguration) {
  MotionConfig config;
  config.min_share = 2.0;
  EXPECT_THROW(DominantMotion{config}, std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::motion
