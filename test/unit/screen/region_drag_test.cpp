#include "screen/region_drag.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::screen {
namespace {

const QRectF kBounds(0, 0, 400, 300);
const QRectF kPresent(100, 100, 80, 60);

std::optional<QRectF> drag(const std::optional<QRectF>& present, const QPointF& from, const QPointF& to,
                           bool anew = false) {
  RegionDrag drag;
  drag.press(from, present, kBounds, anew);
  drag.move(0.5 * (from + to));
  return drag.release(to);
}

TEST(RegionDrag, DrawsInEachDirection) {
  EXPECT_EQ(drag(std::nullopt, {50, 40}, {150, 90}), QRectF(50, 40, 100, 50));
  EXPECT_EQ(drag(std::nullopt, {150, 90}, {50, 40}), QRectF(50, 40, 100, 50));
}

TEST(RegionDrag, AClickDrawsNothing) {
  EXPECT_FALSE(drag(std::nullopt, {50, 40}, {50, 40}));
  EXPECT_FALSE(drag(std::nullopt, {50, 40}, {53, 42})) << "a hand trembles";
  EXPECT_FALSE(drag(kPresent, {140, 130}, {141, 130}));
}

TEST(RegionDrag, WhatBeginsOutsideOfThePictureDrawsNothing) {
  EXPECT_FALSE(drag(std::nullopt, {-5, 40}, {150, 90}));
}

TEST(RegionDrag, IsCutToThePicture) {
  EXPECT_EQ(drag(std::nullopt, {350, 250}, {900, 900}), QRectF(350, 250, 50, 50));
}

TEST(RegionDrag, MovesFromTheInside) {
  EXPECT_EQ(drag(kPresent, {140, 130}, {160, 120}), QRectF(120, 90, 80, 60));
  EXPECT_EQ(drag(kPresent, {140, 130}, {-500, -500}), QRectF(0, 0, 80, 60)) << "it stays in the picture, and its size";
  EXPECT_EQ(drag(kPresent, {140, 130}, {140, 130}, true), std::nullopt);
}

TEST(RegionDrag, ResizesByACorner) {
  EXPECT_EQ(drag(kPresent, {180, 160}, {200, 200}), QRectF(100, 100, 100, 100));
  EXPECT_EQ(drag(kPresent, {100, 100}, {90, 80}), QRectF(90, 80, 90, 80));
  EXPECT_EQ(drag(kPresent, {180, 100}, {50, 300}), QRectF(50, 160, 50, 140)) << "over the opposite corner";
}

TEST(RegionDrag, DrawsAnewInsideWhenAskedTo) {
  EXPECT_EQ(drag(kPresent, {120, 110}, {160, 150}, true), QRectF(120, 110, 40, 40));
  EXPECT_EQ(RegionDrag::kindAt({120, 120}, kPresent, false), RegionDrag::Kind::kMove);
  EXPECT_EQ(RegionDrag::kindAt({101, 101}, kPresent, false), RegionDrag::Kind::kResize);
  EXPECT_EQ(RegionDrag::kindAt({120, 120}, kPresent, true), RegionDrag::Kind::kDraw);
}

TEST(RegionDrag, IsForgottenWhenItIsCancelled) {
  RegionDrag drag;
  drag.press({50, 40}, std::nullopt, kBounds, false);
  drag.move({150, 90});
  EXPECT_TRUE(drag.shown());
  drag.cancel();
  EXPECT_FALSE(drag.shown());
  drag.move({160, 90});
  EXPECT_FALSE(drag.release({160, 90}));
}

}  // namespace
}  // namespace laparoscope_servo::screen
