#include "laparoscope_servo/features/image_sequence.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace laparoscope_servo::features {
namespace {

class ImageSequenceTest : public testing::Test {
 protected:
  const cv::Mat image_ = cv::Mat(20, 30, CV_8UC1, cv::Scalar(90));
  const cv::Mat colour_ = cv::Mat(20, 30, CV_8UC3, cv::Scalar::all(90));
  const cv::Mat turned_ = cv::Mat(30, 20, CV_8UC1, cv::Scalar(90));
  ImageSequence sequence_;
};

TEST_F(ImageSequenceTest, GoesOnWithImagesOfOneKindInTheirOrder) {
  sequence_.begin(image_, 5.0);
  EXPECT_EQ(sequence_.judge(image_, 5.0), Reason::kNone);
  EXPECT_EQ(sequence_.judge(image_, 5.04), Reason::kNone);
  sequence_.goOn(5.04);
  EXPECT_EQ(sequence_.stamp(), 5.04);
  EXPECT_EQ(sequence_.judge(image_, 5.03), Reason::kTimeJumpedBack);
  EXPECT_EQ(sequence_.judge(colour_, 6.0), Reason::kImageChanged);
  EXPECT_EQ(sequence_.judge(turned_, 6.0), Reason::kImageChanged);
}

TEST_F(ImageSequenceTest, WhereSizeAndTimeDifferNamesTheImage) {
  sequence_.begin(image_, 5.0);
  EXPECT_EQ(sequence_.judge(turned_, 4.0), Reason::kImageChanged);
}

TEST_F(ImageSequenceTest, BeginsAnewWithAnyImage) {
  EXPECT_EQ(sequence_.judge(image_, 1.0), Reason::kFirstImage);
  sequence_.begin(image_, 5.0);
  sequence_.begin(colour_, 1.0);
  EXPECT_EQ(sequence_.stamp(), 1.0);
  EXPECT_EQ(sequence_.judge(colour_, 1.0), Reason::kNone);
  EXPECT_EQ(sequence_.judge(image_, 6.0), Reason::kImageChanged);
  sequence_.end();
  EXPECT_EQ(sequence_.judge(colour_, 1.0), Reason::kFirstImage);
}

TEST_F(ImageSequenceTest, RefusesWhatIsNoImageAndNoTimeAndGoesOn) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const bool begun : {false, true}) {
    if (begun) sequence_.begin(image_, 5.0);
    EXPECT_THROW(sequence_.judge({}, 6.0), std::invalid_argument);
    EXPECT_THROW(sequence_.judge(cv::Mat(20, 30, CV_16UC1), 6.0), std::invalid_argument);
    for (const double stamp : {nan, infinity, -infinity})
      EXPECT_THROW(sequence_.judge(image_, stamp), std::invalid_argument) << stamp;
  }
  EXPECT_EQ(sequence_.judge(image_, 6.0), Reason::kNone);
}

}  // namespace
}  // namespace laparoscope_servo::features
