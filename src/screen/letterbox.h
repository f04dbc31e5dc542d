// Where an image lies in a widget that shows all of it as large as it fits, and back.
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
  // Empty sizes give a letterbox that is not valid.
  Letterbox(const QSize& image, const QRectF& canvas);

  bool isValid() const { return scale_ > 0.0; }
  double scale() const { return scale_; }  // of the widget's px to one of the image
  QRectF area() const;                     // of the image, in the widget

  QPointF edgeAt(const QPointF& widget) const { return (widget - origin_) / scale_; }
  QPointF fromEdge(const QPointF& edge) const { return origin_ + scale_ * edge; }
  QPointF fromCentre(const QPointF& centre) const { return fromEdge(centre + QPointF(0.5, 0.5)); }

  // The whole pixels of the image whose edges are nearest to those of a rectangle in the widget, cut to the image.
  QRect pixelsOf(const QRectF& widget) const;
  QRectF fromPixels(const QRect& pixels) const;

 private:
  QSize image_;
  QPointF origin_;
  double scale_ = 0.0;
};

}  // namespace laparoscope_servo::screen
