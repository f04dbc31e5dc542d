#include "screen/select_window.h"

#include <gtest/gtest.h>

#include <QtTest>

#include "screen/letterbox.h"

namespace laparoscope_servo::screen {
namespace {

const QSize kOriginal(1280, 720);  // its picture is half as large

class SelectWindowTest : public testing::Test {
 protected:
  SelectWindowTest() {
    QImage picture(640, 360, QImage::Format_RGB32);
    picture.fill(QColor(180, 70, 60));
    window_ = std::make_unique<SelectWindow>(picture, kOriginal, [this](const QRect& region) {
      Verdict verdict;
      verdict.taken = region.width() >= 100;
      if (!verdict.taken) verdict.why = "ROI is too small, expected at least 100 px", verdict.proposal = proposal_;
      return verdict;
    });
    window_->resize(900, 640);
    window_->show();
  }
  ImageView& image() { return *window_->findChild<ImageView*>("image"); }
  QString words() { return window_->findChild<QLabel*>("words")->text(); }
  void draw(const QPointF& from, const QPointF& to) {
    const Letterbox box(kOriginal, QRectF(image().rect()));
    const QPoint a = box.fromEdge(from).toPoint(), b = box.fromEdge(to).toPoint();
    QTest::mousePress(&image(), Qt::LeftButton, {}, a);
    QMouseEvent move(QEvent::MouseMove, b, Qt::NoButton, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&image(), &move);
    QTest::mouseRelease(&image(), Qt::LeftButton, {}, b);
  }
  void press(int key) { QTest::keyClick(&image(), static_cast<Qt::Key>(key)); }

  // Whether a pixel along the upper edge of a rectangle, in px of the original, has the colour of what would be taken.
  bool isOutlined(const QRect& region) {
    const QRectF outline = Letterbox(kOriginal, QRectF(image().rect())).fromPixels(region);
    const QImage shown = image().grab().toImage();
    for (int x = qRound(outline.left()); x <= qRound(outline.right()); ++x) {
      for (int y = qRound(outline.top()) - 2; y <= qRound(outline.top()) + 2; ++y) {
        if (shown.pixelColor(x, y) == QColor(0x5c, 0xf0, 0x8c)) return true;
      }
    }
    return false;
  }

  QRect proposal_;
  std::unique_ptr<SelectWindow> window_;
};

TEST_F(SelectWindowTest, TakesWhatIsDrawnWhenReturnSaysSo) {
  draw({200, 100}, {600, 400});
  EXPECT_FALSE(window_->selected()) << "it may still be changed";
  press(Qt::Key_Return);
  ASSERT_TRUE(window_->selected());
  EXPECT_NEAR(window_->selected()->x(), 200, 2);
  EXPECT_NEAR(window_->selected()->y(), 100, 2);
  EXPECT_NEAR(window_->selected()->width(), 400, 3);
  EXPECT_FALSE(window_->isVisible());
}

TEST_F(SelectWindowTest, WhatWasDrawnIsMovedByKeysAndByMouse) {
  draw({200, 100}, {600, 400});
  press(Qt::Key_Right);
  press(Qt::Key_Right);
  draw({400, 250}, {500, 350});  // taken at its inside
  press(Qt::Key_Enter);
  ASSERT_TRUE(window_->selected());
  EXPECT_NEAR(window_->selected()->x(), 302, 4);
  EXPECT_NEAR(window_->selected()->y(), 200, 4);
  EXPECT_NEAR(window_->selected()->width(), 400, 4);
}

TEST_F(SelectWindowTest, WhatTheTrackerWouldNotTakeIsNotTaken) {
  draw({200, 100}, {260, 400});
  press(Qt::Key_Return);
  EXPECT_FALSE(window_->selected());
  EXPECT_TRUE(window_->isVisible());
  EXPECT_TRUE(words().startsWith("Not taken: ")) << words().toStdString();
  draw({700, 100}, {900, 400});
  press(Qt::Key_Return);
  EXPECT_TRUE(window_->selected()) << "another one is";
}

TEST_F(SelectWindowTest, ShowsARegionThatWouldDo) {
  const QRect proposal(640, 300, 200, 200);
  draw({200, 100}, {260, 400});
  press(Qt::Key_Return);
  EXPECT_FALSE(words().contains("dotted")) << words().toStdString();
  EXPECT_FALSE(isOutlined(proposal));
  proposal_ = proposal;
  press(Qt::Key_Return);
  EXPECT_TRUE(words().endsWith("The dotted one would do.")) << words().toStdString();
  EXPECT_TRUE(isOutlined(proposal));
}

TEST_F(SelectWindowTest, ReturnWithoutARegionSaysSoAndEscapeEnds) {
  press(Qt::Key_Return);
  EXPECT_TRUE(window_->isVisible());
  EXPECT_TRUE(words().startsWith("There is no region yet.")) << words().toStdString();
  press(Qt::Key_Escape);
  EXPECT_FALSE(window_->isVisible());
  EXPECT_FALSE(window_->selected());
}

}  // namespace
}  // namespace laparoscope_servo::screen
