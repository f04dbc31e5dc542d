#include "screen/space/region_texture.h"

#include <gtest/gtest.h>
#include <laparoscope_servo/AreaSelection.h>
#include <laparoscope_servo/Homography.h>

#include <QPainter>
#include <cmath>
#include <limits>

#include "screen/overlay_painter.h"

namespace laparoscope_servo::screen {
namespace {

constexpr int kSide = 128;

// A camera of 1280x720 with a preview half as large. The region, turned by a quarter, is green but for its top left
// quarter, as it was selected, which is blue.
Facts turned() {
  Facts facts;
  facts.picture.image = QImage(640, 360, QImage::Format_RGB32);
  facts.picture.image.fill(QColor(180, 70, 60));
  {
    QPainter painter(&facts.picture.image);
    painter.fillRect(QRect(200, 100, 100, 100), QColor(40, 200, 40));
    painter.fillRect(QRect(250, 100, 50, 50), QColor(40, 40, 200));
  }
  facts.tracker.width = 1280;
  facts.tracker.height = 720;
  facts.tracker.reference_stamp = 5;
  facts.tracker.region = {300, 200, 499, 200, 499, 399, 300, 399};
  Result result;
  result.reference_stamp = 5;
  result.state = Homography::TRACKING;
  result.corners = {599.5, 199.5, 599.5, 399.5, 399.5, 399.5, 399.5, 199.5};  // top left, top right, ...
  facts.result = result;
  return facts;
}

bool isLike(const QColor& a, const QColor& b) {
  return std::abs(a.red() - b.red()) + std::abs(a.green() - b.green()) + std::abs(a.blue() - b.blue()) < 30;
}

TEST(RegionTexture, IsTheRegionAsItWasSelectedWhateverWayItHasTurned) {
  const QImage texture = regionTexture(turned(), kSide);
  ASSERT_EQ(texture.size(), QSize(kSide, kSide));
  EXPECT_TRUE(isLike(texture.pixelColor(kSide / 4, kSide / 4), {40, 40, 200}));
  for (const QPoint& at : {QPoint(3, 1), QPoint(3, 3), QPoint(1, 3)}) {
    EXPECT_TRUE(isLike(texture.pixelColor(at * kSide / 4), {40, 200, 40})) << at.x() << ' ' << at.y();
  }
  EXPECT_TRUE(isLike(texture.pixelColor(1, kSide / 2), kPresentColour)) << "the outline";
}

TEST(RegionTexture, HatchesWhatIsHiddenAndNothingElse) {
  Facts facts = turned();
  const QImage before = regionTexture(facts, kSide);
  facts.areas = Areas{0, 2, 2, {false, false, true, false}, {0, 0, AreaSelection::STRUCTURE, 0}};
  const QImage after = regionTexture(facts, kSide);
  int changed[2][2] = {};
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) changed[2 * y / kSide][2 * x / kSide] += before.pixel(x, y) != after.pixel(x, y);
  }
  EXPECT_EQ(changed[0][0] + changed[0][1] + changed[1][1], 0);
  EXPECT_GT(changed[1][0], kSide * kSide / 4 * 3 / 4);
  facts.tracker.reference_stamp = 6;  // of another region
  EXPECT_EQ(regionTexture(facts, kSide), before);
}

TEST(RegionTexture, IsNotThereWhereNobodyKnowsWhereTheRegionIs) {
  EXPECT_TRUE(regionTexture({}, kSide).isNull());
  for (const int state : {Homography::IDLE, Homography::LOST}) {
    Facts facts = turned();
    facts.result->state = state;
    EXPECT_TRUE(regionTexture(facts, kSide).isNull()) << state;
  }
  Facts facts = turned();
  facts.result->state = Homography::SEARCHING;
  EXPECT_FALSE(regionTexture(facts, kSide).isNull());
  facts.result->corners[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(regionTexture(facts, kSide).isNull());
  facts.result->corners.fill(7.0);
  EXPECT_TRUE(regionTexture(facts, kSide).isNull()) << "all corners in one point";
}

TEST(RegionTexture, ALabelShowsMarkupAsItIsAndStaysShort) {
  const QImage plain = labelTexture("abc", Qt::white);
  EXPECT_GT(labelTexture("<b>abc</b>", Qt::white).width(), plain.width());
  EXPECT_EQ(labelTexture("a\nb\nc", Qt::white).height(), plain.height());
  EXPECT_LE(labelTexture(QString(4000, 'W'), Qt::white).width(), 700);
}

}  // namespace
}  // namespace laparoscope_servo::screen
