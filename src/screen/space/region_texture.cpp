#include "screen/space/region_texture.h"

#include <laparoscope_servo/Homography.h>

#include <QFontMetrics>
#include <QPainter>
#include <QPolygonF>
#include <QTransform>
#include <cmath>

#include "screen/overlay_painter.h"

namespace laparoscope_servo::screen {

namespace {

constexpr int kLabelHeight = 20;  // px
constexpr int kMostLabel = 640;   // px wide; a longer text is cut

// Of the region now, in the preview's pixels.
QPolygonF cornersInPicture(const Facts& facts) {
  const double across = static_cast<double>(facts.picture.image.width()) / facts.tracker.width;
  const double down = static_cast<double>(facts.picture.image.height()) / facts.tracker.height;
  QPolygonF corners;
  for (std::size_t k = 0; k < 8; k += 2) {
    const QPointF corner(across * (facts.result->corners[k] + 0.5), down * (facts.result->corners[k + 1] + 0.5));
    if (!std::isfinite(corner.x()) || !std::isfinite(corner.y())) return {};
    corners << corner;
  }
  return corners;
}

void drawHidden(QPainter& painter, const Areas& areas, int side) {
  painter.setPen(Qt::NoPen);
  const double width = static_cast<double>(side) / areas.columns, height = static_cast<double>(side) / areas.rows;
  for (int row = 0; row < areas.rows; ++row) {
    for (int column = 0; column < areas.columns; ++column) {
      const QRectF cell(column * width, row * height, width, height);
      drawHiddenArea(painter, QPolygonF(cell), areas, static_cast<std::size_t>(row) * areas.columns + column);
    }
  }
}

}  // namespace

QImage regionTexture(const Facts& facts, int side) {
  if (!facts.result || facts.picture.image.isNull() || facts.tracker.width < 1 || facts.tracker.height < 1) return {};
  const bool sure = facts.result->state == Homography::TRACKING;
  if (!sure && facts.result->state != Homography::SEARCHING) return {};
  const QPolygonF corners = cornersInPicture(facts);
  const QPolygonF square(QVector<QPointF>{{0, 0}, {double(side), 0}, {double(side), double(side)}, {0, double(side)}});
  QTransform straighten;
  if (corners.size() != 4 || !QTransform::quadToQuad(corners, square, straighten)) return {};
  QImage texture(side, side, QImage::Format_ARGB32);
  texture.fill(QColor(0x30, 0x30, 0x30));  // outside of the picture
  QPainter painter(&texture);
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  painter.setTransform(straighten);
  painter.drawImage(0, 0, facts.picture.image);
  painter.resetTransform();
  if (facts.areas && facts.result->reference_stamp == facts.tracker.reference_stamp)
    drawHidden(painter, *facts.areas, side);
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(kPresentColour, 0.06 * side, sure ? Qt::SolidLine : Qt::DotLine));
  painter.drawRect(texture.rect());
  return texture;
}

QImage labelTexture(const QString& text, const QColor& frame) {
  QFont font;
  font.setPixelSize(13);
  font.setBold(true);
  const QFontMetrics metrics(font);
  const QString shown = metrics.elidedText(text.simplified(), Qt::ElideRight, kMostLabel);
  QImage label(metrics.horizontalAdvance(shown) + 12, kLabelHeight, QImage::Format_ARGB32);
  label.fill(QColor(0, 0, 0, 215));
  QPainter painter(&label);
  painter.setFont(font);
  painter.setPen(QPen(frame, 2));
  painter.drawRect(label.rect().adjusted(1, 1, -1, -1));
  painter.setPen(Qt::white);
  painter.drawText(label.rect(), Qt::AlignCenter | Qt::TextSingleLine, shown);
  return label;
}

}  // namespace laparoscope_servo::screen
