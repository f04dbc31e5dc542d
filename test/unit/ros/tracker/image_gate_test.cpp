#include "ros/tracker/image_gate.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "ros/tracker/image_conversion.h"

namespace laparoscope_servo {
namespace {

const cv::Size kSize(640, 480);

class ImageGateTest : public testing::Test {
 protected:
  // Empty when the image is refused; then refusal_ says why.
  std::optional<ImageGate::Passed> see(double stamp, const cv::Size& size = kSize, int channels = 3) {
    try {
      return gate_.judge(ros::Time(stamp), size, channels);
    } catch (const ImageError& error) {
      refusal_ = error.what();
      cause_ = error.cause();
      return std::nullopt;
    }
  }
  void film(double from, int images) {
    for (int k = 0; k < images; ++k) ASSERT_TRUE(see(from + 0.04 * k)) << refusal_;
  }

  ImageGate gate_{tracking::InputConfig()};
  std::string refusal_;
  Refusal cause_ = Refusal::kData;
};

TEST_F(ImageGateTest, PassesAFilmWithJitterAndGaps) {
  for (const double stamp : {100.0, 100.04, 100.041, 100.12, 100.2, 101.9}) {
    const auto passed = see(stamp);
    ASSERT_TRUE(passed) << refusal_;
    EXPECT_EQ(passed->step_back, 0.0);
    EXPECT_FALSE(passed->other_size);
  }
}

TEST_F(ImageGateTest, RefusesSingleStampsThatDoNotGoOnAndGoesOnAsIfTheyHadNotCome) {
  const struct {
    double stamp;
    const char* why;
  } cases[] = {{100.355, "s before"}, {100.36, "repeats the stamp"},
               {100.0, "s before"},   {0.0, "zero"},
               {1.0, "s before"},     {200.0, "s after"},
               {1e9, "s after"}};
  for (const auto& test : cases) {
    ImageGate fresh{tracking::InputConfig()};
    std::swap(gate_, fresh);
    film(100.0, 10);  // until 100.36
    EXPECT_FALSE(see(test.stamp)) << test.stamp;
    EXPECT_NE(refusal_.find(test.why), std::string::npos) << refusal_;
    EXPECT_EQ(cause_, Refusal::kStamp);
    for (int k = 1; k < 10; ++k) {
      const auto passed = see(100.36 + 0.04 * k);
      ASSERT_TRUE(passed) << test.stamp << ": " << refusal_;
      EXPECT_EQ(passed->step_back, 0.0);
    }
  }
}

TEST_F(ImageGateTest, BelievesALoopWithTheThirdImage) {
  film(100.0, 100);
  EXPECT_FALSE(see(100.0));
  EXPECT_FALSE(see(100.04));
  const auto passed = see(100.08);
  ASSERT_TRUE(passed);
  EXPECT_NEAR(passed->step_back, 3.88, 1e-6);
  EXPECT_TRUE(passed->loop);
  EXPECT_NEAR(passed->period, 0.04, 1e-6);
  EXPECT_TRUE(see(100.12));
}

TEST_F(ImageGateTest, BelievesALoopAtOnceWhenTheClockHasJumped) {
  film(100.0, 50);
  gate_.clockJumpedBack();
  EXPECT_TRUE(see(102.0)) << "an image that was on its way";
  const auto passed = see(100.0);
  ASSERT_TRUE(passed);
  EXPECT_TRUE(passed->loop);
  EXPECT_FALSE(see(99.0)) << "one jump of the clock is one loop";
}

TEST_F(ImageGateTest, TakesASmallStepOfAClockForNoLoop) {
  film(100.0, 25);  // until 100.96
  EXPECT_FALSE(see(100.5));
  EXPECT_FALSE(see(100.54));
  const auto passed = see(100.58);
  ASSERT_TRUE(passed);
  EXPECT_FALSE(passed->loop);
  EXPECT_GT(passed->step_back, 0.0);
}

TEST_F(ImageGateTest, IsNotTalkedIntoALoopByImagesThatDoNotAgree) {
  film(100.0, 25);
  for (const double stamp : {50.0, 20.0, 80.0, 10.0, 5.0, 1.0}) EXPECT_FALSE(see(stamp)) << stamp;
  EXPECT_TRUE(see(101.0));
  // One from each of two times in turn.
  for (int k = 1; k < 20; ++k) {
    EXPECT_TRUE(see(101.0 + 0.04 * k));
    EXPECT_FALSE(see(50.0 + 0.04 * k));
  }
}

TEST_F(ImageGateTest, BelievesAPauseWithTheSecondImage) {
  film(100.0, 25);
  EXPECT_FALSE(see(130.0));
  const auto passed = see(130.04);
  ASSERT_TRUE(passed);
  EXPECT_EQ(passed->step_back, 0.0);
}

TEST_F(ImageGateTest, RefusesOddSizesUntilTheyLast) {
  film(100.0, 10);
  EXPECT_FALSE(see(100.4, cv::Size(1, 1)));
  EXPECT_EQ(cause_, Refusal::kSize);
  EXPECT_NE(refusal_.find("1x1 px, in colour, those before 640x480"), std::string::npos) << refusal_;
  EXPECT_TRUE(see(100.4));
  for (int k = 0; k < 20; ++k) {  // two cameras in turn
    EXPECT_FALSE(see(100.44 + 0.04 * k, cv::Size(320, 240)));
    EXPECT_TRUE(see(100.45 + 0.04 * k));
  }
  EXPECT_FALSE(see(102.0, cv::Size(320, 240)));
  EXPECT_FALSE(see(102.04, cv::Size(320, 240)));
  const auto passed = see(102.08, cv::Size(320, 240));
  ASSERT_TRUE(passed) << refusal_;
  EXPECT_TRUE(passed->other_size);
  EXPECT_TRUE(see(102.12, cv::Size(320, 240)));
  EXPECT_FALSE(see(102.16));
}

TEST_F(ImageGateTest, RefusesGreyAmongColourUntilItLasts) {
  film(100.0, 10);
  EXPECT_FALSE(see(100.4, kSize, 1));
  EXPECT_FALSE(see(100.44, kSize, 1));
  EXPECT_TRUE(see(100.48, kSize, 1));
}

TEST_F(ImageGateTest, RefusesADriverThatStampsNothing) {
  EXPECT_TRUE(see(0.0)) << "a recording may begin at 0";
  for (int k = 0; k < 10; ++k) EXPECT_FALSE(see(0.0));
  EXPECT_NE(refusal_.find("zero"), std::string::npos) << refusal_;
  EXPECT_THROW(checkStamp(ros::Time(), ros::Time(1000.0), 0.1), ImageError);
}

TEST(CheckStamp, RefusesTheFutureOfAClockThatRuns) {
  EXPECT_NO_THROW(checkStamp(ros::Time(1000.05), ros::Time(1000.0), 0.1));
  EXPECT_THROW(checkStamp(ros::Time(1000.2), ros::Time(1000.0), 0.1), ImageError);
  EXPECT_NO_THROW(checkStamp(ros::Time(900.0), ros::Time(1000.0), 0.1));
  EXPECT_NO_THROW(checkStamp(ros::Time(1000.0), ros::Time(), 0.1)) << "the clock has not started";
}

}  // namespace
}  // namespace laparoscope_servo
