#include "screen/level_symbol.h"

namespace laparoscope_servo::screen {

QColor levelColour(Level level) {
  switch (level) {
    case Level::kGood:
      return {0x2e, 0xb8, 0x5c};
    case Level::kWaiting:
      return {0xf2, 0xa9, 0x1e};
    case Level::kBad:
      return {0xe5, 0x3a, 0x3a};
    case Level::kResting:
      return {0x5b, 0x8d, 0xd6};
    case Level::kUnknown:
      break;
  }
  return {0x7a, 0x80, 0x8a};
}

void drawLevelSymbol(QPainter& painter, Level level, const QPointF& centre, double radius) {
  const double r = radius;
  painter.setPen(QPen(Qt::black, 2));
  painter.setBrush(Qt::white);
  switch (level) {
    case Level::kGood:
      painter.drawPolygon(
          QPolygonF({centre + QPointF(-r * 0.8, -r), centre + QPointF(r, 0), centre + QPointF(-r * 0.8, r)}));
      break;
    case Level::kWaiting:
      painter.drawRect(QRectF(centre + QPointF(-r * 0.8, -r), QSizeF(r * 0.6, 2 * r)));
      painter.drawRect(QRectF(centre + QPointF(r * 0.2, -r), QSizeF(r * 0.6, 2 * r)));
      break;
    case Level::kBad:
      painter.setPen(QPen(Qt::white, 6.0 * r / 13.0, Qt::SolidLine, Qt::RoundCap));
      painter.drawLine(centre + QPointF(-r * 0.7, -r * 0.7), centre + QPointF(r * 0.7, r * 0.7));
      painter.drawLine(centre + QPointF(-r * 0.7, r * 0.7), centre + QPointF(r * 0.7, -r * 0.7));
      break;
    case Level::kResting:
      painter.drawRect(QRectF(centre + QPointF(-r * 0.85, -r * 0.85), QSizeF(1.7 * r, 1.7 * r)));
      break;
    case Level::kUnknown:
      painter.setBrush(Qt::NoBrush);
      painter.setPen(QPen(Qt::white, 4.0 * r / 13.0));
      painter.drawEllipse(centre, r * 0.8, r * 0.8);
      break;
  }
}

}  // namespace laparoscope_servo::screen
