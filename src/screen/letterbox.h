// Converts between an image and the widget that shows the whole of it as large as possible.
//
// Two kinds of coordinates of the image, px: of edges (0 is the image's left edge, width its right one), in which a
// region's corners are drawn and rounded, and of centres (0 is the centre of the first pixel), in which the tracker
// gives points. Edge = centre + 0.5.
#pragma once

#include <QPointF>
#include <QRect>
#include <QRectF>
#include <QSize>

namespace laparoscope_servo::screen {

class Letterbox {
 public:
  Letterbox() = default;
  // Invalid for empty sizes.
  Letterbox(const QSize& image, const QRectF& canvas);

  bool isValid() const { return scale_ > 0.0; }
  double scale() const { return scale_; }  // px of the widget per px of the image
  QRectF area() const;                     // area of the image in the widget

  QPointF edgeAt(const QPointF& widget) const { return (widget - origin_) / scale_; }
  QPointF fromEdge(const QPointF& edge) const { return origin_ + scale_ * edge; }
  QPointF fromCentre(const QPointF& centre) const { return fromEdge(centre + QPointF(0.5, 0.5)); }

  // A rectangle of the widget in whole pixels of the image (nearest edges), cut to the image.
  QRect pixelsOf(const QRectF& widget) const;
  QRectF fromPixels(const QRect& pixels) const;

 private:
  QSize image_;
  QPointF origin_;
  double scale_ = 0.0;
};

}  // namespace laparoscope_servo::screen
