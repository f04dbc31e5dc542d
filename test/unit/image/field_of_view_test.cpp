#include "laparoscope_servo/image/field_of_view.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::image {
namespace {

TEST(FieldOfView, IsTheHullOfWhatIsLit) {
  cv::Mat1b level(100, 120, uchar{0});
  cv::circle(level, {60, 50}, 40, 120, cv::FILLED);
  // A dark shaft bites into the circle, and a bright pixel lies beyond it.
  cv::rectangle(level, {90, 45}, {119, 55}, 5, cv::FILLED);
  level(2, 2) = 255;
  FieldOfView view;
  view.compute(level);
  EXPECT_TRUE(view.contains(60, 50));
  EXPECT_TRUE(view.contains(97, 50));
  EXPECT_FALSE(view.contains(104, 50));
  EXPECT_FALSE(view.contains(2, 2));
  EXPECT_FALSE(view.contains(-1, 50));
  EXPECT_FALSE(view.contains(60, 100));
  EXPECT_NEAR(view.area(), 3.1416 * 40 * 40, 200);
  EXPECT_TRUE(view.isDeep(60, 50, 5));
  EXPECT_FALSE(view.isDeep(60, 12, 5));
}

TEST(FieldOfView, OfABlackImageIsEmpty) {
  FieldOfView view;
  view.compute(cv::Mat1b(50, 60, uchar{3}));
  EXPECT_EQ(view.area(), 0);
  EXPECT_FALSE(view.contains(30, 25));
}

}  // namespace
}  // namespace laparoscope_servo::image
