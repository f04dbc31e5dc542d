#include "laparoscope_servo/image/image_type.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

namespace laparoscope_servo::image {
namespace {

TEST(CheckType, TakesGreyAndColourOfEightBitAndNamesAnother) {
  for (const int type : {CV_8UC1, CV_8UC3}) EXPECT_NO_THROW(checkType(cv::Mat(2, 3, type))) << type;
  for (const int type : {CV_8UC2, CV_8UC4, CV_8SC1, CV_16UC1, CV_16UC3, CV_32FC1}) {
    try {
      checkType(cv::Mat(2, 3, type));
      ADD_FAILURE() << type;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("type " + std::to_string(type) + ","), std::string::npos)
          << error.what();
    }
  }
}

TEST(CheckImage, AnImageHasPixelsAndAStamp) {
  const cv::Mat image(4, 4, CV_8UC3);
  EXPECT_NO_THROW(checkImage(image, -3.5));
  EXPECT_THROW(checkImage(cv::Mat(), 1.0), std::invalid_argument);
  EXPECT_THROW(checkImage(cv::Mat(4, 4, CV_16UC1), 1.0), std::invalid_argument);
  EXPECT_THROW(checkImage(image, std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
  EXPECT_THROW(checkImage(image, std::numeric_limits<double>::infinity()), std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::image
