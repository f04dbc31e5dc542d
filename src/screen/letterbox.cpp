#include "screen/letterbox.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::screen {

Letterbox::Letterbox(const QSize& image, const QRectF& canvas) : image_(image) {
  if (image.isEmpty() || !(canvas.width() > 0.0) || !(canvas.height() > 0.0)) return;
  scale_ = std::min(canvas.width() / image.width(), canvas.height() / image.height());
  origin_ = canvas.center() - 0.5 * scale_ * QPointF(image.width(), image.height());
}

QRectF Letterbox::area() const {
  return {origin_, QSizeF(scale_ * image_.width(), scale_ * image_.height())};
}

QRect Letterbox::pixelsOf(const QRectF& widget) const {
  const QPointF first = edgeAt(widget.topLeft());
  const QPointF last = edgeAt(widget.bottomRight());
  const auto pixel = [](double edge, int size) { return std::clamp(static_cast<int>(std::lround(edge)), 0, size); };
  const int left = pixel(first.x(), image_.width());
  const int top = pixel(first.y(), image_.height());
  return {left, top, pixel(last.x(), image_.width()) - left, pixel(last.y(), image_.height()) - top};
}

QRectF Letterbox::fromPixels(const QRect& pixels) const {
  return {fromEdge(pixels.topLeft()), scale_ * QSizeF(pixels.size())};
}

}  // namespace laparoscope_servo::screen
