#include "motion/region_window.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo::motion {
namespace {

const cv::Size kImage(640, 480);

geometry::Quadrilateral at(double x, double y, double width, double height) {
  return geometry::Rectangle{x, y, width, height}.corners();
}

TEST(RegionWindow, HasAMarginOfHalfTheRegion) {
  const RegionWindow window({300.0, 200.0, 60.0, 80.0}, kImage);
  EXPECT_EQ(window.about(at(300.0, 200.0, 60.0, 80.0)), cv::Rect(270, 160, 120, 160));
}

// Whatever becomes of the region: buffers are not allocated anew.
TEST(RegionWindow, GoesAlongInOneSizeAndStaysWithinTheImage) {
  const RegionWindow window({300.0, 200.0, 60.0, 80.0}, kImage);
  for (const geometry::Quadrilateral& region :
       {at(-40.0, 200.0, 60.0, 80.0), at(600.0, 440.0, 90.0, 120.0), at(300.0, -300.0, 10.0, 10.0)}) {
    const cv::Rect box = window.about(region);
    EXPECT_EQ(box.size(), cv::Size(120, 160));
    EXPECT_EQ(box & cv::Rect({}, kImage), box);
  }
  const cv::Rect moved = window.about(at(310.0, 195.0, 60.0, 80.0));
  EXPECT_EQ(moved.tl(), cv::Point(280, 155));
}

TEST(RegionWindow, IsNoLargerThanTheImageAndNoSmallerThanTheEstimatorNeeds) {
  EXPECT_EQ(RegionWindow({10.0, 10.0, 600.0, 400.0}, kImage).about(at(10.0, 10.0, 600.0, 400.0)),
            cv::Rect(0, 0, 640, 480));
  EXPECT_EQ(RegionWindow({8.0, 8.0, 20.0, 48.0}, {64, 64}).about(at(8.0, 8.0, 20.0, 48.0)), cv::Rect(0, 0, 64, 64));
}

TEST(RegionWindow, ARegionThatIsNotFiniteHasAWindow) {
  const RegionWindow window({300.0, 200.0, 60.0, 80.0}, kImage);
  const cv::Rect box = window.about(at(std::nan(""), 200.0, 60.0, 80.0));
  EXPECT_EQ(box & cv::Rect({}, kImage), box);
}

}  // namespace
}  // namespace laparoscope_servo::motion
