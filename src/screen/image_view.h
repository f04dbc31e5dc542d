// Shows the picture with the tracker's results, and the region that is drawn by mouse.
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
  using Region = std::function<void(const QRect&)>;  // in whole pixels of the original image
  // `drawn`: called when a region was drawn; a click draws none. `changed`: called while it is being drawn, to check
  // it.
  ImageView(const Region& drawn, const Region& changed, QWidget* parent);

  void show(const Facts& facts, double now);
  // Whether the features of other trackers are drawn, with their legend.
  void drawFeatures(bool draw);
  void cancelDrag();
  // `taken`: called when a region that the tracker offers is taken, by a click in it or by Return.
  void takeOffers(const std::function<void(const Offer&)>& taken) { offer_taken_ = taken; }
  // What was drawn stays, to be moved, until Return gives it.
  void keepDrafts() { keeps_drafts_ = true; }
  QSize sizeHint() const override { return {640, 480}; }
  QSize minimumSizeHint() const override { return {240, 180}; }

 private:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  void leaveEvent(QEvent* event) override;
  bool canDraw() const;
  std::optional<QRectF> present() const;  // the region that can be moved
  std::optional<QRect> shown() const;     // the region being drawn, px of the original image
  std::optional<Offer> offer() const;     // the region that is offered, while none is being drawn
  bool isOffered(const QPointF& at) const;
  void tellChange();
  void give(const QRect& pixels);
  Letterbox letterbox() const;
  void drawPicture(QPainter& painter, const QRectF& area);
  void drawFrozen(QPainter& painter, const QRectF& area, double now);
  void showCursor(const QPointF& at, bool anew);

  Region drawn_;
  Region changed_;
  std::function<void(const Offer&)> offer_taken_;
  std::optional<Offer> given_up_;  // by the right button
  Facts facts_;
  double now_ = 0.0;
  PictureWords words_;
  RegionDrag drag_;
  std::optional<QRect> draft_;  // region moved by keys, not sent yet
  bool keeps_drafts_ = false;
  bool draws_features_ = true;
  std::optional<QPointF> mouse_;  // while it is over the picture
  QRect asked_;
};

}  // namespace laparoscope_servo::screen
