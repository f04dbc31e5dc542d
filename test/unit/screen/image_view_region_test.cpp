// A region that the user draws, moves and selects, by mouse and keys.
#include <algorithm>
#include <cmath>

#include "screen/region_painter.h"
#include "unit/screen/image_view_fixture.h"

namespace laparoscope_servo::screen {
namespace {

class ImageViewRegion : public ImageViewTest {};

TEST_F(ImageViewRegion, ARegionIsDrawnInPixelsOfTheOriginalImageAtAnySize) {
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

TEST_F(ImageViewRegion, AClickDrawsNothingNorDoesAPictureThatIsNotLive) {
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
  Facts features = tracked();
  features.picture.original = QSize(1280, 720);
  view_.show(features, kNow);
  drag({100, 100}, {300, 300});
  EXPECT_TRUE(regions_.empty()) << "the picture is not the region tracker's";
}

TEST_F(ImageViewRegion, TheRegionThatThereIsIsMovedFromItsInside) {
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

// Within a pixel of the screen, of each edge.
TEST_F(ImageViewRegion, ItIsMovedResizedAndNudgedWithinOnePixelOfTheScreenAtAnySize) {
  const auto isWithin = [](const QRect& region, const QRect& wanted, double scale) {
    const double pixel = std::max(1.0, 1.0 / scale);
    return std::abs(region.left() - wanted.left()) <= pixel && std::abs(region.top() - wanted.top()) <= pixel &&
           std::abs(region.right() - wanted.right()) <= pixel && std::abs(region.bottom() - wanted.bottom()) <= pixel;
  };
  const QRect present(500, 300, 200, 150);
  for (const QSize& size : {QSize(1280, 720), QSize(500, 700), QSize(1900, 400), QSize(2560, 1440)}) {
    view_.resize(size);
    view_.show(tracked(), kNow);
    const Letterbox box(QSize(1280, 720), QRectF(view_.rect()));
    const QPoint begin = box.fromEdge({600, 370}).toPoint(), end = box.fromEdge({471, 433}).toPoint();
    const QPointF way = QPointF(end - begin) / box.scale();
    drag(begin, end);
    ASSERT_FALSE(regions_.empty());
    EXPECT_TRUE(isWithin(regions_.back(), present.translated(way.toPoint()), box.scale())) << size.width();
    view_.show(tracked(), kNow);
    drag(box.fromEdge({700, 450}).toPoint(), box.fromEdge({761, 473}).toPoint());
    EXPECT_TRUE(isWithin(regions_.back(), QRect(500, 300, 261, 173), box.scale())) << size.width();
    view_.show(tracked(), kNow);
    for (int k = 0; k < 7; ++k) QTest::keyClick(&view_, Qt::Key_Right);
    QTest::keyClick(&view_, Qt::Key_Up, Qt::ShiftModifier);
    QTest::keyClick(&view_, Qt::Key_Return);
    EXPECT_TRUE(isWithin(regions_.back(), present.translated(7, -10), box.scale())) << size.width();
  }
  EXPECT_EQ(regions_.size(), 12u);
}

TEST_F(ImageViewRegion, AsksForARegionWhileItIsDrawnAndShowsTheAnswer) {
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

TEST_F(ImageViewRegion, ARegionThatTheTrackerOffersIsTakenByAClickOrAKey) {
  view_.resize(1280, 720);
  Facts facts = tracked();
  facts.result->state = Homography::LOST;
  facts.tracker.state = "LOST";
  const QImage without = drawn(facts);
  facts.tracker.proposal = QRect(800, 400, 120, 100);
  facts.picture.arrived_at += 0.01;
  EXPECT_EQ(drawn(facts), without) << "nobody would take it";
  std::vector<Offer> taken;
  view_.takeOffers([&](const Offer& offer) { taken.push_back(offer); });
  facts.picture.arrived_at += 0.01;
  const QImage with = drawn(facts);
  int dots = 0, gaps = 0;
  for (int x = 800; x < 920; ++x) (with.pixelColor(x, 400).green() > 150 ? dots : gaps) += 1;
  EXPECT_GT(dots, 20) << "dotted";
  EXPECT_GT(gaps, 20);
  QTest::mouseClick(&view_, Qt::LeftButton, {}, QPoint(700, 300));
  EXPECT_TRUE(taken.empty()) << "a click elsewhere";
  QTest::mouseClick(&view_, Qt::LeftButton, {}, QPoint(860, 450));
  ASSERT_EQ(taken.size(), 1u);
  EXPECT_EQ(taken[0].region, facts.tracker.proposal);
  EXPECT_EQ(taken[0].stamp, 5);
  QTest::keyClick(&view_, Qt::Key_Return);
  EXPECT_EQ(taken.size(), 2u);
  EXPECT_TRUE(regions_.empty());
  drag({820, 420}, {900, 480});
  EXPECT_EQ(taken.size(), 2u) << "a drag draws, as elsewhere";
  EXPECT_EQ(regions_.size(), 1u);
  view_.show(facts, kNow + 5.0);
  QTest::mouseClick(&view_, Qt::LeftButton, {}, QPoint(860, 450));
  QTest::keyClick(&view_, Qt::Key_Return);
  EXPECT_EQ(taken.size(), 2u) << "the picture is not live";
  view_.show(facts, kNow);
  QTest::mouseClick(&view_, Qt::RightButton, {}, QPoint(300, 300));
  QTest::keyClick(&view_, Qt::Key_Return);
  EXPECT_EQ(taken.size(), 2u) << "the right button gives it up";
  facts.tracker.proposal.translate(10, 0);
  view_.show(facts, kNow);
  QTest::keyClick(&view_, Qt::Key_Return);
  EXPECT_EQ(taken.size(), 3u) << "another one is offered";
}

TEST_F(ImageViewRegion, ArrowsNudgeTheRegionAndReturnSelectsIt) {
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

TEST_F(ImageViewRegion, ARegionIsDrawnInAFrozenPictureWhileTheLiveOneMovesOn) {
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
