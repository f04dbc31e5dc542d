#include "features/shafts/shaft.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo::features {
namespace {

constexpr int kSide = 200;  // cells

image::FieldOfView wholeView() {
  image::FieldOfView view;
  view.compute(cv::Mat1b(kSide, kSide, uchar{120}));
  return view;
}

// Enters from the left at the row `y` and points along x, its edges seen from x = 20 to 120.
std::array<GreyLine, 2> edges(double y, double width) {
  std::array<GreyLine, 2> lines;
  lines[0].point = {70.0, y + 0.5 * width};  // on the right of who looks along x: below
  lines[0].normal = {0.0, 1.0};
  lines[1].point = {70.0, y - 0.5 * width};
  lines[1].normal = {0.0, -1.0};
  for (GreyLine& line : lines) {
    line.begin = -50.0;
    line.end = 50.0;
  }
  return lines;
}

Shaft shaftAt(double y, double width) {
  Shaft shaft;
  follow(wholeView(), edges(y, width), shaft);
  return shaft;
}

TEST(Shaft, axisEntryLengthAndWidthFollowFromItsEdges) {
  const Shaft shaft = shaftAt(80.0, 12.0);
  EXPECT_NEAR((shaft.axis - Eigen::Vector2d::UnitX()).norm(), 0.0, 1e-12);
  EXPECT_NEAR(shaft.entry.y(), 80.0, 1e-9);
  EXPECT_NEAR(shaft.entry.x(), 0.0, 1.5) << "at the picture's border, though its edges are seen from 20 on only";
  EXPECT_NEAR(shaft.at(shaft.length).x(), 120.0, 1e-9);
  EXPECT_NEAR(shaft.width, 12.0, 1e-9);
  EXPECT_NEAR(shaft.widthAt(60.0), 12.0, 1e-9);
}

TEST(Shaft, anEdgeThatIsNotSeenDoesNotLengthenIt) {
  std::array<GreyLine, 2> lines = edges(80.0, 12.0);
  lines[1].begin = -60.0;
  lines[1].end = 90.0;
  Shaft shaft;
  shaft.seen[0] = false;
  follow(wholeView(), lines, shaft);
  EXPECT_NEAR(shaft.at(shaft.length).x(), 160.0, 1e-9);
  // The direction of edge 1 is that of the axis, of edge 0 against it.
  lines = edges(80.0, 12.0);
  lines[0].begin = -90.0;
  shaft.seen = {true, false};
  follow(wholeView(), lines, shaft);
  EXPECT_NEAR(shaft.at(shaft.length).x(), 160.0, 1e-9);
}

TEST(Shaft, isTheSameWhereEachCoversTheOther) {
  const Shaft shaft = shaftAt(80.0, 12.0);
  EXPECT_TRUE(isSame(shaft, shaft));
  EXPECT_TRUE(isSame(shaft, shaftAt(83.0, 12.0)));
  EXPECT_FALSE(isSame(shaft, shaftAt(100.0, 12.0)));
  EXPECT_FALSE(overlaps(shaft, shaftAt(100.0, 12.0)));
  Shaft turned = shaft;
  turned.axis = -shaft.axis;
  EXPECT_FALSE(isSame(shaft, turned)) << "it would enter from the other side";
  // A thin one within a wide one, off its axis.
  EXPECT_TRUE(overlaps(shaftAt(80.0, 40.0), shaftAt(95.0, 6.0)));
}

TEST(Shaft, edgesThatMeetNowhereEndAndAreNoShaft) {
  for (const double wrong : {std::nan(""), 1e200}) {
    std::array<GreyLine, 2> lines = edges(80.0, 12.0);
    lines[0].point.y() = wrong;
    Shaft shaft;
    follow(wholeView(), lines, shaft);
    EXPECT_FALSE(shaft.width > 0.0 && shaft.width < kSide) << wrong;
  }
}

}  // namespace
}  // namespace laparoscope_servo::features
