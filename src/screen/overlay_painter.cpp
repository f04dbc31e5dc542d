#include "screen/overlay_painter.h"

#include <laparoscope_servo/AreaSelection.h>
#include <laparoscope_servo/Homography.h>

#include <QPolygonF>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "screen/legend.h"

namespace laparoscope_servo::screen {

namespace {

const QColor kRecorded(0xff, 0x80, 0xff);
constexpr double kFarAway = 1e5;  // px: further out nothing is drawn

using Corners = std::array<double, 8>;

// Empty when a corner is nowhere.
QPolygonF polygonOf(const Corners& corners, const Letterbox& letterbox) {
  QPolygonF polygon;
  for (std::size_t k = 0; k < 8; k += 2) {
    if (!(std::abs(corners[k]) < kFarAway && std::abs(corners[k + 1]) < kFarAway)) return {};
    polygon << letterbox.fromCentre({corners[k], corners[k + 1]});
  }
  return polygon;
}

void drawOutline(QPainter& painter, const QPolygonF& polygon, const QColor& colour, Qt::PenStyle style, double width) {
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(kCasing, width + 3.0));
  painter.drawPolygon(polygon);
  QPen pen(colour, width, style, Qt::FlatCap);
  if (style == Qt::CustomDashLine) pen.setDashPattern({4.0, 3.0});
  painter.setPen(pen);
  painter.drawPolygon(polygon);
}

void drawTarget(QPainter& painter, const QPolygonF& polygon) {
  drawOutline(painter, polygon, kTargetColour, Qt::CustomDashLine, 2.0);
  painter.setPen(QPen(kCasing, 1));
  painter.setBrush(kTargetColour);
  for (const QPointF& corner : polygon) painter.drawRect(QRectF(corner - QPointF(4, 4), QSizeF(8, 8)));
}

// A cause that hides an area, and how it is drawn.
struct Cause {
  std::uint8_t code;
  const char* words;
  QColor colour;
  Qt::BrushStyle form;
};
const Cause kCauses[] = {
    {AreaSelection::COLOUR, "covered: another colour", {0x20, 0x40, 0xe0}, Qt::BDiagPattern},
    {AreaSelection::STRUCTURE, "covered: another structure", {0xa0, 0x20, 0xb0}, Qt::DiagCrossPattern},
    {AreaSelection::HIGHLIGHT, "highlight", {0x60, 0x60, 0x60}, Qt::Dense6Pattern},
    {AreaSelection::BORDER, "outside of the picture", {0x10, 0x10, 0x10}, Qt::HorPattern}};

const Cause* causeOf(const Areas& areas, std::size_t area) {
  const std::uint8_t code = area < areas.cause.size() ? areas.cause[area] : std::uint8_t{0};
  for (const Cause& cause : kCauses) {
    if (cause.code == code) return &cause;
  }
  return areas.covered[area] ? &kCauses[0] : nullptr;
}

template <class Shape>
void fill(QPainter& painter, const Shape& shape, const Cause& cause) {
  QColor background = cause.colour;
  background.setAlpha(120);
  for (const QBrush& brush : {QBrush(background), QBrush(QColor(255, 255, 255, 210), cause.form)}) {
    painter.setBrush(brush);
    painter.drawPolygon(shape);
  }
}

// As in the tracker: each area is the same share of the region.
void drawAreas(QPainter& painter, const Areas& areas, const Result& result, const Corners& region,
               const Letterbox& letterbox) {
  const double left = region[0] - 0.5;
  const double top = region[1] - 0.5;
  const double width = (region[4] + 0.5 - left) / areas.columns;
  const double height = (region[5] + 0.5 - top) / areas.rows;
  painter.setPen(Qt::NoPen);
  for (int row = 0; row < areas.rows; ++row) {
    for (int column = 0; column < areas.columns; ++column) {
      const std::size_t area = static_cast<std::size_t>(row) * areas.columns + column;
      if (causeOf(areas, area) == nullptr) continue;
      QPolygonF cell;
      for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        const double x = left + (column + u) * width;
        const double y = top + (row + v) * height;
        const double w = result.g[6] * x + result.g[7] * y + result.g[8];
        const QPointF p((result.g[0] * x + result.g[1] * y + result.g[2]) / w,
                        (result.g[3] * x + result.g[4] * y + result.g[5]) / w);
        if (std::abs(p.x()) < kFarAway && std::abs(p.y()) < kFarAway) cell << letterbox.fromCentre(p);
      }
      if (cell.size() == 4) drawHiddenArea(painter, cell, areas, area);
    }
  }
}

// Dashes and dots, with a cross at each corner.
void drawRecorded(QPainter& painter, const QPolygonF& polygon) {
  drawOutline(painter, polygon, kRecorded, Qt::DashDotLine, 2.0);
  painter.setPen(QPen(kRecorded, 2));
  for (const QPointF& corner : polygon) {
    painter.drawLine(corner - QPointF(5, 5), corner + QPointF(5, 5));
    painter.drawLine(corner - QPointF(5, -5), corner + QPointF(5, -5));
  }
}

bool hasPresent(const Facts& facts) {
  return facts.result && (facts.result->state == Homography::TRACKING || facts.result->state == Homography::SEARCHING);
}

}  // namespace

void drawHiddenArea(QPainter& painter, const QPolygonF& shape, const Areas& areas, std::size_t area) {
  if (const Cause* cause = causeOf(areas, area)) fill(painter, shape, *cause);
}

void drawOverlay(QPainter& painter, const Facts& facts, const Letterbox& letterbox) {
  if (!facts.result || !letterbox.isValid()) return;
  const Result& result = *facts.result;
  const bool known = result.reference_stamp != 0 && result.reference_stamp == facts.tracker.reference_stamp;
  painter.save();
  painter.setClipRect(letterbox.area());
  painter.setRenderHint(QPainter::Antialiasing);
  if (known && facts.areas && hasPresent(facts)) {
    drawAreas(painter, *facts.areas, result, facts.tracker.region, letterbox);
  }
  if (known) drawTarget(painter, polygonOf(facts.tracker.region, letterbox));
  if (hasPresent(facts)) {
    const bool sure = result.state == Homography::TRACKING;
    drawOutline(painter, polygonOf(result.corners, letterbox), kPresentColour, sure ? Qt::SolidLine : Qt::DotLine, 3.0);
  }
  if (facts.recorded && facts.recorded->state == Homography::TRACKING)
    drawRecorded(painter, polygonOf(facts.recorded->corners, letterbox));
  painter.restore();
}

void drawLegend(QPainter& painter, const QRectF& canvas, bool recorded) {
  constexpr int kRows = 3 + static_cast<int>(std::size(kCauses));
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  Legend legend(painter, canvas, Legend::Corner::kLeft, kLegendWidth, kRows + (recorded ? 1 : 0));
  const auto sample = [&](const QRectF& at, const QColor& colour, Qt::PenStyle style, double width) {
    drawOutline(painter, QPolygonF(QVector<QPointF>{{at.left(), at.center().y()}, {at.right(), at.center().y()}}),
                colour, style, width);
  };
  sample(legend.next("where the region is"), kPresentColour, Qt::SolidLine, 3.0);
  sample(legend.next("where it is looked for"), kPresentColour, Qt::DotLine, 3.0);
  const QRectF target = legend.next("where it shall be");
  sample(target, kTargetColour, Qt::CustomDashLine, 2.0);
  painter.setBrush(kTargetColour);
  painter.drawRect(QRectF(target.left() - 3, target.center().y() - 4, 8, 8));
  for (const Cause& cause : kCauses) {
    const QRectF at = legend.next(cause.words);
    painter.setPen(Qt::NoPen);
    fill(painter, QPolygonF(at.adjusted(0, 2, 0, -2)), cause);
  }
  if (recorded) sample(legend.next("where it was when recorded"), kRecorded, Qt::DashDotLine, 2.0);
  painter.restore();
}

std::optional<QRectF> presentRegion(const Facts& facts, const Letterbox& letterbox) {
  if (!hasPresent(facts) || !letterbox.isValid()) return std::nullopt;
  const QPolygonF polygon = polygonOf(facts.result->corners, letterbox);
  if (polygon.isEmpty()) return std::nullopt;
  // From the centres of the outermost pixels to their edges.
  const double half = 0.5 * letterbox.scale();
  return polygon.boundingRect().adjusted(-half, -half, half, half) & letterbox.area();
}

}  // namespace laparoscope_servo::screen
