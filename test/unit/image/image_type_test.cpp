#include "laparoscope_servo/image/image_type.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace laparoscope_servo::image
