// A widget of the picture for tests, and what it is given to show.
#pragma once

#include <gtest/gtest.h>
#include <laparoscope_servo/Homography.h>

#include <QtTest>
#include <vector>

#include "screen/image_view.h"
#include "support/like_colour.h"

namespace laparoscope_servo::screen {

constexpr double kNow = 100.0;

// A camera of 1280x720, whose preview is half as large; the region has moved by (200, 100) px.
inline Facts tracked() {
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
        if (laparoscope_servo::test_support::isLike(image.pixelColor(x, y), colour)) ++found;
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

}  // namespace laparoscope_servo::screen
