// The picture, what the tracker says of it, and the region that is drawn by mouse.
#pragma once

#include <QWidget>
#include <functional>

#include "screen/facts.h"
#include "screen/letterbox.h"
#include "screen/picture_words.h"
#include "screen/region_drag.h"

namespace laparoscope_servo::screen {

class ImageView : public QWidget {
  Q_OBJECT
 public:
  // `drawn`: a region, in whole pixels of the original image. A click draws none.
  ImageView(const std::function<void(const QRect&)>& drawn, QWidget* parent);

  void show(const Facts& facts, double now);
  void cancelDrag();
  QSize sizeHint() const override { return {640, 480}; }
  QSize minimumSizeHint() const override { return {240, 180}; }

 private:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  Letterbox letterbox() const;
  void drawPicture(QPainter& painter, const QRectF& area);
  void drawDrag(QPainter& painter);
  void showCursor(const QPointF& at, bool anew);

  std::function<void(const QRect&)> drawn_;
  Facts facts_;
  PictureWords words_;
  RegionDrag drag_;
};

}  // namespace laparoscope_servo::screen
