// What is drawn over the picture.
#include <laparoscope_servo/AreaSelection.h>

#include <limits>
#include <memory>

#include "unit/screen/image_view_fixture.h"

namespace laparoscope_servo::screen {
namespace {

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
  facts.verdict = Verdict{QRect(1, 2, 30, 40), 0, true, ""};
  EXPECT_EQ(paintsFor(facts), 1) << "an answer";
  facts.verdict->taken = false;
  EXPECT_EQ(paintsFor(facts), 1) << "another answer about the same region";
  facts.frozen = Frozen{facts.picture.image, 77, QSize(1280, 720), kNow};
  EXPECT_EQ(paintsFor(facts), 1) << "a frozen picture";
  facts.frozen->stamp = 78;
  EXPECT_EQ(paintsFor(facts), 1) << "another one";
  facts.frozen->at -= 3.0;
  EXPECT_EQ(paintsFor(facts), 1) << "its age, also when no live picture comes";
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

// White pixels at the sides of the picture would be words that are cut off.
TEST_F(ImageViewTest, WordsAreNotWiderThanThePicture) {
  view_.resize(500, 400);
  Facts facts = tracked();
  facts.playback.connected = true;
  facts.playback.state = "ENDED";
  const QImage image = drawn(facts);
  const QRectF picture = Letterbox(QSize(1280, 720), QRectF(view_.rect())).area();
  int white = 0, at_the_sides = 0;
  for (int y = static_cast<int>(picture.top()); y < picture.bottom(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (qGray(image.pixel(x, y)) < 200) continue;
      ++white;
      if (x < picture.left() + 4 || x > picture.right() - 4) ++at_the_sides;
    }
  }
  EXPECT_GT(white, 1000);
  EXPECT_EQ(at_the_sides, 0);
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

}  // namespace
}  // namespace laparoscope_servo::screen
