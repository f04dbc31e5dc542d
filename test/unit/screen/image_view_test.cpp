#include "screen/image_view.h"

#include <gtest/gtest.h>
#include <laparoscope_servo/AreaSelection.h>
#include <laparoscope_servo/Homography.h>

#include <QtTest>
#include <cmath>
#include <limits>
#include <vector>

#include "screen/overlay_painter.h"
#include "screen/region_painter.h"

namespace laparoscope_servo::screen {
namespace {

constexpr double kNow = 100.0;

// A camera of 1280x720, whose preview is half as large; the region has moved by (200, 100) px.
Facts tracked() {
  Facts facts;
  facts.master = true;
  facts.picture.image = QImage(640, 360, QImage::Format_RGB32);
  facts.picture.image.fill(QColor(180, 70, 60));
  facts.picture.arrived_at = facts.picture.changed_at = kNow;
  facts.tracker.width = 1280;
  facts.tracker.height = 720;
  facts.tracker.reference_stamp = 5;
  facts.tracker.region = {300, 200, 499, 200, 499, 349, 300, 349};
  Result result;
  result.reference_stamp = 5;
  result.state = Homography::TRACKING;
  result.g = {1, 0, 200, 0, 1, 100, 0, 0, 1};
  result.corners = {500, 300, 699, 300, 699, 449, 500, 449};
  facts.result = result;
  facts.areas = Areas{0, 2, 2, {false, false, true, false}};
  return facts;
}

class ImageViewTest : public testing::Test {
 protected:
  QImage drawn(const Facts& facts, double now = kNow) {
    view_.show(facts, now);
    QImage image(view_.size(), QImage::Format_RGB32);
    view_.render(&image);
    return image;
  }
  // Pixels near this place of the original image that have nearly this colour.
  int near(const QImage& image, double u, double v, const QColor& colour) {
    const Letterbox box(QSize(1280, 720), QRectF(view_.rect()));
    const QPoint at = box.fromCentre({u, v}).toPoint();
    int found = 0;
    for (int y = at.y() - 3; y <= at.y() + 3; ++y) {
      for (int x = at.x() - 3; x <= at.x() + 3; ++x) {
        if (!image.rect().contains(x, y)) continue;
        const QColor c = image.pixelColor(x, y);
        if (std::abs(c.red() - colour.red()) + std::abs(c.green() - colour.green()) +
                std::abs(c.blue() - colour.blue()) <
            60)
          ++found;
      }
    }
    return found;
  }
  void drag(const QPoint& from, const QPoint& to) {
    QTest::mousePress(&view_, Qt::LeftButton, {}, from);
    QMouseEvent move(QEvent::MouseMove, 0.5 * QPointF(from + to), Qt::NoButton, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&view_, &move);
    QTest::mouseRelease(&view_, Qt::LeftButton, {}, to);
  }

  std::vector<QRect> regions_;
  std::vector<QRect> asked_;
  ImageView view_{[this](const QRect& region) { regions_.push_back(region); },
                  [this](const QRect& region) { asked_.push_back(region); }, nullptr};
};

const QColor kPresent(0xff, 0xe0, 0x30);
const QColor kTarget(0x40, 0xe0, 0xff);

TEST_F(ImageViewTest, DrawsTheRegionWhereItIsAndWhereItShallBe) {
  for (const QSize& size : {QSize(1000, 700), QSize(640, 700)}) {
    view_.resize(size);
    const QImage image = drawn(tracked());
    EXPECT_GT(near(image, 600, 300, kPresent), 0) << "top edge, " << size.width();
    EXPECT_GT(near(image, 699, 370, kPresent), 0) << "right edge";
    EXPECT_EQ(near(image, 600, 370, kPresent), 0) << "inside";
    EXPECT_GT(near(image, 300, 200, kTarget), 5) << "marked corner";
    EXPECT_GT(near(image, 300, 349, kTarget), 5);
  }
}

// What the widget asks for after a change, without being told to draw.
TEST_F(ImageViewTest, RepaintsForEachThingThatIsDrawn) {
  class Watch : public QObject {
   public:
    bool eventFilter(QObject*, QEvent* event) override {
      paints += event->type() == QEvent::Paint ? 1 : 0;
      return false;
    }
    int paints = 0;
  } watch;
  view_.resize(1280, 720);
  view_.QWidget::show();
  view_.installEventFilter(&watch);
  const auto paintsFor = [&](const Facts& facts) {
    QApplication::processEvents();
    watch.paints = 0;
    view_.show(facts, kNow);
    QApplication::processEvents();
    return watch.paints;
  };
  Facts facts = tracked();
  paintsFor(facts);
  EXPECT_EQ(paintsFor(facts), 0) << "nothing has changed";
  facts.master = false;
  EXPECT_EQ(paintsFor(facts), 1) << "the legend";
  facts.features.resize(1);
  EXPECT_EQ(paintsFor(facts), 1) << "a tracker of features";
  facts.features[0].drawn = std::make_shared<FeatureResult>();
  EXPECT_EQ(paintsFor(facts), 1) << "its result";
  facts.features[0].heard_at = 7.0;
  EXPECT_EQ(paintsFor(facts), 0) << "is not drawn";
}

TEST_F(ImageViewTest, FeaturesAreDrawnUntilTheyAreSwitchedOff) {
  view_.resize(1280, 720);
  Facts facts = tracked();
  const QImage without = drawn(facts);
  auto result = std::make_shared<FeatureResult>();
  FeatureFact line;
  line.kind = 1;   // LINE
  line.state = 1;  // TRACKING
  line.outline << QPointF(100, 600) << QPointF(900, 600);
  result->features.push_back(line);
  facts.features.resize(1);
  facts.features[0].drawn = result;
  const QImage with = drawn(facts);
  EXPECT_GT(near(with, 500, 600, QColor(0x60, 0xff, 0x60)), 5);
  view_.drawFeatures(false);
  EXPECT_EQ(drawn(facts), without) << "also without their legend";
  view_.drawFeatures(true);
  EXPECT_EQ(drawn(facts), with);
  EXPECT_EQ(near(drawn(facts, kNow + 5.0), 500, 600, QColor(0x60, 0xff, 0x60)), 0) << "the picture is not live";
}

TEST_F(ImageViewTest, HatchesCoveredAreasWhereTheyAreNow) {
  view_.resize(1280, 720);
  const QImage image = drawn(tracked());
  const QColor tissue(180, 70, 60);
  EXPECT_EQ(near(image, 550, 412, tissue), 0) << "bottom left of the region";
  EXPECT_EQ(near(image, 650, 412, tissue), 49) << "bottom right";
  EXPECT_EQ(near(image, 350, 312, tissue), 49) << "and not in the reference";
}

// With neither colour nor form the same.
TEST_F(ImageViewTest, EachCauseHasAFormOfItsOwn) {
  view_.resize(1280, 720);
  std::vector<QImage> cells;
  for (const int cause :
       {AreaSelection::COLOUR, AreaSelection::STRUCTURE, AreaSelection::HIGHLIGHT, AreaSelection::BORDER}) {
    Facts facts = tracked();
    facts.areas = Areas{0, 1, 1, {false}, {static_cast<std::uint8_t>(cause)}};
    const QRect inside(520, 320, 32, 32);
    const QImage cell = drawn(facts).copy(inside).convertToFormat(QImage::Format_Grayscale8);
    int dark = 0;
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) dark += qGray(cell.pixel(x, y)) < 150 ? 1 : 0;
    }
    EXPECT_GT(dark, 100) << "the tissue is still seen, cause " << cause;
    EXPECT_LT(dark, 32 * 32 - 20) << "its form is seen without colour, cause " << cause;
    for (const QImage& other : cells) EXPECT_NE(cell, other);
    cells.push_back(cell);
  }
  Facts none = tracked();
  none.areas = Areas{0, 1, 1, {false}, {AreaSelection::NONE}};
  EXPECT_EQ(near(drawn(none), 600, 370, QColor(180, 70, 60)), 49);
}

TEST_F(ImageViewTest, DrawsWhereItWasWhenItWasRecordedInAFormOfItsOwn) {
  view_.resize(1280, 720);
  Facts facts = tracked();
  const QImage before = drawn(facts);
  facts.recorded = facts.result;
  facts.recorded->corners = {800, 300, 999, 300, 999, 449, 800, 449};
  const QImage after = drawn(facts);
  const QColor recorded(0xff, 0x80, 0xff);
  for (const double v : {300.0, 449.0}) {
    EXPECT_GT(near(after, 800, v, recorded), 5) << "a cross at each corner";
    EXPECT_GT(near(after, 999, v, recorded), 5);
  }
  EXPECT_EQ(near(after, 900, 370, recorded), 0) << "inside";
  int drawn_pixels = 0;
  for (int u = 820; u < 980; ++u) {
    const QColor c = after.pixelColor(u, 300);
    drawn_pixels += c.red() > 200 && c.blue() > 200 ? 1 : 0;
  }
  EXPECT_GT(drawn_pixels, 60);
  EXPECT_LT(drawn_pixels, 130) << "its line has gaps";
  const QRect legend(0, 720 - 160, 240, 160);
  EXPECT_NE(before.copy(legend), after.copy(legend)) << "the legend has a line for it";
  facts.recorded->state = Homography::SEARCHING;
  EXPECT_EQ(near(drawn(facts), 800, 300, recorded), 0);
}

TEST_F(ImageViewTest, DrawsNoResultOfAnotherImageOrRegion) {
  view_.resize(1280, 720);
  Facts other = tracked();
  other.result->reference_stamp = 6;
  EXPECT_EQ(near(drawn(other), 300, 200, kTarget), 0) << "the reference of another selection";
  other = tracked();
  other.result.reset();
  EXPECT_EQ(near(drawn(other), 600, 300, kPresent), 0);
  other = tracked();
  other.result->state = Homography::LOST;
  EXPECT_EQ(near(drawn(other), 600, 300, kPresent), 0) << "lost: nobody knows where it is";
  other = tracked();
  other.result->corners[0] = std::numeric_limits<double>::quiet_NaN();
  other.result->g[8] = 0.0;
  drawn(other);
}

TEST_F(ImageViewTest, AnOldPictureIsGreyAndSaysSo) {
  view_.resize(1280, 720);
  const QImage live = drawn(tracked());
  EXPECT_GT(live.pixelColor(900, 100).saturation(), 100);
  const QImage old = drawn(tracked(), kNow + 2.0);
  EXPECT_EQ(old.pixelColor(900, 100).saturation(), 0);
  int white = 0;
  for (int y = 0; y < old.height(); ++y) {
    for (int x = 0; x < old.width(); ++x) white += old.pixel(x, y) == qRgb(255, 255, 255) ? 1 : 0;
  }
  EXPECT_GT(white, 2000) << "the words";
  EXPECT_EQ(near(old, 600, 300, kPresent), 0) << "what was there is no word on what is there";
}

TEST_F(ImageViewTest, ARegionIsDrawnInPixelsOfTheOriginalImageAtAnySize) {
  Facts facts = tracked();
  facts.result.reset();
  for (const QSize& size : {QSize(1280, 720), QSize(500, 700), QSize(1900, 400)}) {
    view_.resize(size);
    view_.show(facts, kNow);
    const Letterbox box(QSize(1280, 720), QRectF(view_.rect()));
    const QRect wanted(320, 180, 400, 300);
    drag(box.fromEdge(wanted.topLeft()).toPoint(), box.fromEdge(wanted.topLeft() + QPoint(400, 300)).toPoint());
    ASSERT_FALSE(regions_.empty());
    const double pixel = 1.0 / box.scale() + 1.0;
    EXPECT_NEAR(regions_.back().x(), wanted.x(), pixel);
    EXPECT_NEAR(regions_.back().y(), wanted.y(), pixel);
    EXPECT_NEAR(regions_.back().width(), wanted.width(), 2 * pixel);
    EXPECT_NEAR(regions_.back().height(), wanted.height(), 2 * pixel);
  }
  EXPECT_EQ(regions_.size(), 3u);
}

TEST_F(ImageViewTest, AClickDrawsNothingNorDoesAPictureThatIsNotLive) {
  view_.resize(1280, 720);
  view_.show(tracked(), kNow);
  QTest::mouseClick(&view_, Qt::LeftButton, {}, QPoint(100, 100));
  QTest::mouseDClick(&view_, Qt::LeftButton, {}, QPoint(100, 100));
  QTest::mouseClick(&view_, Qt::RightButton, {}, QPoint(100, 100));
  EXPECT_TRUE(regions_.empty());
  view_.show(tracked(), kNow + 1.0);
  drag({100, 100}, {300, 300});
  EXPECT_TRUE(regions_.empty());
  Facts unknown = tracked();
  unknown.tracker.width = 0;
  view_.show(unknown, kNow);
  drag({100, 100}, {300, 300});
  EXPECT_TRUE(regions_.empty()) << "of which size is the image?";
}

TEST_F(ImageViewTest, TheRegionThatThereIsIsMovedFromItsInside) {
  view_.resize(1280, 720);
  view_.show(tracked(), kNow);
  drag({600, 370}, {580, 390});
  ASSERT_EQ(regions_.size(), 1u);
  EXPECT_EQ(regions_[0], QRect(480, 320, 200, 150));
  view_.show(tracked(), kNow);
  drag({700, 450}, {760, 470});
  ASSERT_EQ(regions_.size(), 2u);
  EXPECT_EQ(regions_[1], QRect(500, 300, 260, 170)) << "resized by its corner";
}

TEST_F(ImageViewTest, AsksForARegionWhileItIsDrawnAndShowsTheAnswer) {
  view_.resize(1280, 720);
  Facts facts = tracked();
  facts.result.reset();
  view_.show(facts, kNow);
  QTest::mousePress(&view_, Qt::LeftButton, {}, {100, 100});
  QMouseEvent move(QEvent::MouseMove, QPointF(300, 260), Qt::NoButton, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(&view_, &move);
  ASSERT_EQ(asked_.size(), 1u);
  EXPECT_EQ(asked_[0], QRect(100, 100, 200, 160));
  EXPECT_TRUE(regions_.empty()) << "nothing is selected by asking";
  const QImage unanswered = drawn(facts);
  facts.verdict = Verdict{asked_[0], 0, true, ""};
  const QImage taken = drawn(facts);
  facts.verdict = Verdict{asked_[0], 0, false, "ROI x=1 has too little texture: 2 grey levels"};
  facts.picture.arrived_at += 0.01;
  const QImage refused = drawn(facts);
  EXPECT_NE(unanswered, taken);
  EXPECT_NE(taken, refused);
  EXPECT_EQ(wordsOf(*facts.verdict).toStdString(),
            "The region is too smooth to be followed. Choose one with vessels or edges.");
  facts.verdict->proposal = QRect(20, 20, 60, 60);
  facts.picture.arrived_at += 0.01;
  EXPECT_NE(drawn(facts), refused);
  EXPECT_EQ(wordsOf(*facts.verdict).right(24).toStdString(), "The dotted one would do.");
  facts.verdict = Verdict{QRect(1, 2, 3, 4), 0, true, ""};
  facts.picture.arrived_at += 0.01;
  EXPECT_EQ(drawn(facts), unanswered) << "the answer is of another region";
  QTest::mouseRelease(&view_, Qt::LeftButton, {}, {300, 260});
  EXPECT_EQ(regions_.size(), 1u);
}

TEST_F(ImageViewTest, ArrowsNudgeTheRegionAndReturnSelectsIt) {
  view_.resize(500, 400);
  view_.show(tracked(), kNow);
  QTest::keyClick(&view_, Qt::Key_Right);
  QTest::keyClick(&view_, Qt::Key_Down, Qt::ShiftModifier);
  EXPECT_TRUE(regions_.empty());
  ASSERT_EQ(asked_.size(), 2u);
  EXPECT_EQ(asked_[1].topLeft() - asked_[0].topLeft(), QPoint(0, 10)) << "px of the original image at any size";
  QTest::keyClick(&view_, Qt::Key_Return);
  ASSERT_EQ(regions_.size(), 1u);
  EXPECT_NEAR(regions_[0].x(), 501, 3);
  EXPECT_NEAR(regions_[0].y(), 310, 3);
  QTest::keyClick(&view_, Qt::Key_Return);
  EXPECT_EQ(regions_.size(), 1u) << "given once";
  QTest::keyClick(&view_, Qt::Key_Left);
  view_.cancelDrag();
  QTest::keyClick(&view_, Qt::Key_Return);
  EXPECT_EQ(regions_.size(), 1u) << "STOP gives it up";
  for (int k = 0; k < 100; ++k) QTest::keyClick(&view_, Qt::Key_Left, Qt::ShiftModifier);
  EXPECT_EQ(asked_.back().x(), 0) << "not out of the picture";
}

TEST_F(ImageViewTest, ARegionIsDrawnInAFrozenPictureWhileTheLiveOneMovesOn) {
  view_.resize(1280, 720);
  Facts facts = tracked();
  Frozen frozen;
  frozen.image = QImage(640, 360, QImage::Format_RGB32);
  frozen.image.fill(QColor(20, 160, 40));
  frozen.stamp = 77;
  frozen.size = QSize(1280, 720);
  frozen.at = kNow;
  facts.frozen = frozen;
  facts.picture.arrived_at += 0.01;
  const QImage image = drawn(facts);
  EXPECT_EQ(near(image, 600, 500, QColor(20, 160, 40)), 49);
  EXPECT_EQ(near(image, 1100, 150, QColor(180, 70, 60)), 49) << "the live one, small";
  EXPECT_EQ(near(image, 600, 300, kPresent), 0) << "what is found in the live one is not drawn over it";
  view_.show(facts, kNow + 5.0);  // the live picture is none any more
  drag({200, 300}, {400, 460});
  ASSERT_EQ(regions_.size(), 1u);
  EXPECT_EQ(regions_[0], QRect(200, 300, 200, 160));
}

}  // namespace
}  // namespace laparoscope_servo::screen
