#include "screen/letterbox.h"

#include <gtest/gtest.h>

#include <vector>

namespace laparoscope_servo::screen {
namespace {

TEST(Letterbox, ShowsAllOfTheImageInTheMiddle) {
  const Letterbox wide(QSize(640, 360), QRectF(0, 0, 1280, 1000));
  EXPECT_EQ(wide.scale(), 2.0);
  EXPECT_EQ(wide.area(), QRectF(0, 140, 1280, 720));
  const Letterbox high(QSize(640, 360), QRectF(10, 20, 1280, 180));
  EXPECT_EQ(high.scale(), 0.5);
  EXPECT_EQ(high.area(), QRectF(490, 20, 320, 180));
}

TEST(Letterbox, CentresAndEdgesDifferByHalfAPixel) {
  const Letterbox box(QSize(100, 100), QRectF(0, 0, 400, 400));
  EXPECT_EQ(box.fromCentre({0.0, 0.0}), QPointF(2, 2)) << "the middle of the first pixel";
  EXPECT_EQ(box.fromEdge({0.0, 0.0}), QPointF(0, 0));
  EXPECT_EQ(box.edgeAt({400.0, 200.0}), QPointF(100, 50));
}

TEST(Letterbox, PixelsThatAreDrawnAreTheOnesThatAreTaken) {
  for (const QSize& image : {QSize(1920, 1080), QSize(720, 576), QSize(333, 777)}) {
    for (const QSizeF& canvas : {QSizeF(1001, 700), QSizeF(320.5, 240), QSizeF(3000, 90)}) {
      const Letterbox box(image, QRectF(QPointF(3, 7), canvas));
      for (const QRect& region : {QRect(0, 0, 50, 40), QRect(100, 90, 121, 33), QRect(QPoint(0, 0), image)}) {
        EXPECT_EQ(box.pixelsOf(box.fromPixels(region)), region);
      }
    }
  }
}

// Half a pixel of the screen is what a hand can hit: so many of the image at most.
TEST(Letterbox, ARegionIsWithinOnePixelOfTheScreen) {
  const Letterbox box(QSize(1920, 1080), QRectF(0, 0, 700, 500));
  const QRectF drawn(QPointF(100, 120), QPointF(301, 333));
  const QRectF taken = box.fromPixels(box.pixelsOf(drawn));
  EXPECT_NEAR(taken.left(), drawn.left(), 1.0);
  EXPECT_NEAR(taken.top(), drawn.top(), 1.0);
  EXPECT_NEAR(taken.right(), drawn.right(), 1.0);
  EXPECT_NEAR(taken.bottom(), drawn.bottom(), 1.0);
}

TEST(Letterbox, RegionsAreCutToTheImage) {
  const Letterbox box(QSize(100, 80), QRectF(0, 0, 200, 160));
  EXPECT_EQ(box.pixelsOf(QRectF(-50, -50, 100, 100)), QRect(0, 0, 25, 25));
  EXPECT_EQ(box.pixelsOf(QRectF(150, 120, 900, 900)), QRect(75, 60, 25, 20));
}

TEST(Letterbox, OfNothingIsNotValid) {
  EXPECT_FALSE(Letterbox().isValid());
  EXPECT_FALSE(Letterbox(QSize(0, 0), QRectF(0, 0, 10, 10)).isValid());
  EXPECT_FALSE(Letterbox(QSize(10, 10), QRectF(0, 0, 0, 10)).isValid());
  EXPECT_TRUE(Letterbox(QSize(1, 1), QRectF(0, 0, 10, 10)).isValid());
}

}  // namespace
}  // namespace laparoscope_servo::screen
