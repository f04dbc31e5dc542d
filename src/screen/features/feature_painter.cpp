#include "screen/features/feature_painter.h"

#include <laparoscope_servo/TrackedFeatures.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>

#include "screen/deviations.h"
#include "screen/features/feature_spread.h"
#include "screen/legend.h"
#include "screen/overlay_painter.h"
#include "screen/picture_words.h"

namespace laparoscope_servo::screen {

namespace {

constexpr double kWidth = 2.0;        // px of lines
constexpr double kLeastSpread = 2.5;  // px of the widget: a narrower band would be hidden by its line
constexpr double kMostSpread = 200.0;
constexpr double kBorder = 1.6;  // px, of a spread
constexpr double kMark = 7.0;    // px, radius

struct Look {
  QColor colour;
  Qt::PenStyle style = Qt::SolidLine;
};

void stroke(QPainter& painter, const QPolygonF& line, const Look& look, double width = kWidth) {
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(kCasing, width + 2.0));
  painter.drawPolyline(line);
  painter.setPen(QPen(look.colour, width, look.style, Qt::FlatCap));
  painter.drawPolyline(line);
}

QPolygonF inWidget(const QPolygonF& outline, const Letterbox& letterbox) {
  QPolygonF points;
  for (const QPointF& point : outline) points << letterbox.fromCentre(point);
  return points;
}

// Of length 1, across a polyline at one of its points; zero where it has no length.
QPointF normalAt(const QPolygonF& line, int k) {
  const QPointF along = line[std::min(k + 1, line.size() - 1)] - line[std::max(k - 1, 0)];
  const double length = std::hypot(along.x(), along.y());
  return length > 0.0 ? QPointF(-along.y(), along.x()) / length : QPointF();
}

// A cross in a ring.
void drawMark(QPainter& painter, const QPointF& at, const Look& look) {
  for (const auto& [colour, width, style] :
       {std::tuple(kCasing, kWidth + 2.0, Qt::SolidLine), {look.colour, kWidth, look.style}}) {
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(colour, width, style));
    painter.drawEllipse(at, kMark, kMark);
    painter.setPen(QPen(colour, width));
    painter.drawLine(at - QPointF(kMark / 2, 0), at + QPointF(kMark / 2, 0));
    painter.drawLine(at - QPointF(0, kMark / 2), at + QPointF(0, kMark / 2));
  }
}

// The bar across each end of a straight edge, and the head of an arrow.
void drawBars(QPainter& painter, const QPolygonF& line, const Look& look) {
  for (const int k : {0, line.size() - 1}) {
    const QPointF across = 5.0 * normalAt(line, k);
    stroke(painter, QPolygonF(QVector<QPointF>{line[k] - across, line[k] + across}), {look.colour});
  }
}

void drawArrow(QPainter& painter, const QPolygonF& line, const Look& look) {
  stroke(painter, line, {look.colour, look.style == Qt::SolidLine ? Qt::DashDotLine : look.style});
  const QPointF across = normalAt(line, 1), along(across.y(), -across.x());
  const QPointF head = line[1];
  stroke(painter, QPolygonF({head - 10.0 * along + 5.0 * across, head, head - 10.0 * along - 5.0 * across}),
         {look.colour});
}

// Pen and brush of a spread.
void takeVeil(QPainter& painter, const QColor& colour) {
  QColor veil = colour;
  veil.setAlpha(60);
  painter.setPen(QPen(colour, kBorder));
  painter.setBrush(veil);
}

// `line`: its outline in the widget.
void drawSpread(QPainter& painter, const FeatureFact& feature, const QPolygonF& line, const Letterbox& letterbox,
                const QColor& colour) {
  takeVeil(painter, colour);
  if (const std::optional<Eigen::Matrix2d> around = spreadAround(feature)) {
    const QPointF centre(feature.parameters[0], feature.parameters[1]);
    QPolygonF ellipse;
    for (int k = 0; k < 36; ++k) {
      const double turn = 2.0 * M_PI * k / 36;
      const Eigen::Vector2d offset = *around * Eigen::Vector2d(std::cos(turn), std::sin(turn));
      ellipse << letterbox.fromCentre(centre + QPointF(offset.x(), offset.y()));
    }
    if (around->norm() * letterbox.scale() < kMostSpread) painter.drawPolygon(ellipse);
    return;
  }
  const std::vector<double> spread = spreadAlong(feature);
  if (spread.empty() || line.size() < 2) return;
  const double scale = kDeviations * letterbox.scale();
  const double widest = scale * *std::max_element(spread.begin(), spread.end());
  if (!(widest >= kLeastSpread && widest <= kMostSpread)) return;
  QPolygonF band;
  for (int k = 0; k < line.size(); ++k)
    band << line[k] + scale * spread[static_cast<std::size_t>(k)] * normalAt(line, k);
  for (int k = line.size() - 1; k >= 0; --k)
    band << line[k] - scale * spread[static_cast<std::size_t>(k)] * normalAt(line, k);
  painter.drawPolygon(band);
}

// Within `area`, whatever is asked for.
void drawWords(QPainter& painter, const QRectF& area, QPointF left_bottom, const QString& words, const QColor& colour) {
  QFont font = painter.font();
  font.setPixelSize(13);
  font.setBold(true);
  painter.setFont(font);
  QRectF box = QFontMetricsF(font).boundingRect(words).translated(left_bottom).adjusted(-3, -1, 3, 1);
  const QPointF inside(std::max(area.left(), std::min(box.left(), area.right() - box.width())),
                       std::max(area.top(), std::min(box.top(), area.bottom() - box.height())));
  left_bottom += inside - box.topLeft();
  box.moveTo(inside);
  painter.fillRect(box, QColor(0, 0, 0, 170));
  painter.setPen(colour);
  painter.drawText(left_bottom, words);
}

bool isDrawn(const FeatureFact& feature) {
  const bool somewhere = feature.state == TrackedFeatures::TRACKING || feature.state == TrackedFeatures::SEARCHING;
  return somewhere && !feature.outline.isEmpty();
}

// px of the widget, from the mouse to the nearest corner of the outline.
double distanceTo(const FeatureFact& feature, const Letterbox& letterbox, const QPointF& mouse) {
  double least = std::numeric_limits<double>::infinity();
  for (const QPointF& point : feature.outline) {
    const QPointF apart = letterbox.fromCentre(point) - mouse;
    least = std::min(least, std::hypot(apart.x(), apart.y()));
  }
  return least;
}

// Which of many features is named: the nearest one within reach of the mouse; null: none.
const FeatureFact* featureAt(const FeatureResult& result, const Letterbox& letterbox,
                             const std::optional<QPointF>& mouse) {
  constexpr double kReach = 20.0;  // px of the widget
  const FeatureFact* nearest = nullptr;
  double least = kReach;
  for (const FeatureFact& feature : result.features) {
    if (!mouse || !isDrawn(feature)) continue;
    const double distance = distanceTo(feature, letterbox, *mouse);
    if (distance <= least) least = distance, nearest = &feature;
  }
  return nearest;
}

// Where its name stands in the widget.
QPointF labelOf(const FeatureFact& feature, const Letterbox& letterbox) {
  const bool axis = feature.kind == TrackedFeature::POSE && feature.outline.size() == 2;
  const QPointF at = axis ? (feature.outline[0] + feature.outline[1]) / 2 : feature.outline.first();
  return letterbox.fromCentre(at) + QPointF(8, -6);
}

// Where it is in the widget; empty when nothing of it is drawn.
QRectF drawFeature(QPainter& painter, const FeatureFact& feature, const Letterbox& letterbox, const QColor& colour) {
  if (!isDrawn(feature)) return {};
  const bool seen = feature.state == TrackedFeatures::TRACKING;
  const QPolygonF line = inWidget(feature.outline, letterbox);
  if (seen) drawSpread(painter, feature, line, letterbox, colour);
  const Look look{colour, seen ? Qt::SolidLine : Qt::DotLine};
  if (line.size() == 1) {
    drawMark(painter, line.first(), look);
  } else if (feature.kind == TrackedFeature::POSE && line.size() == 2) {
    drawArrow(painter, line, look);
  } else if (feature.kind == TrackedFeature::POSE || feature.kind == TrackedFeature::MOTION) {
    // Points of an object's edges, which do not join.
    painter.setPen(QPen(kCasing, 1));
    painter.setBrush(seen ? QBrush(colour) : QBrush(Qt::NoBrush));
    for (const QPointF& point : line) painter.drawEllipse(point, 3.0, 3.0);
  } else {
    stroke(painter, line, look);
    if (feature.kind == TrackedFeature::LINE) drawBars(painter, line, look);
  }
  return line.boundingRect().adjusted(0, 0, 1, 1);
}

}  // namespace

void drawFeatures(QPainter& painter, const Facts& facts, const Letterbox& letterbox,
                  const std::optional<QPointF>& mouse) {
  if (!letterbox.isValid()) return;
  painter.save();
  painter.setClipRect(letterbox.area());
  painter.setRenderHint(QPainter::Antialiasing);
  for (const FeatureTrackerFacts& tracker : facts.features) {
    if (!tracker.drawn) continue;
    const double age = 1e-9 * static_cast<double>(facts.picture.stamp - tracker.drawn->stamp);
    if (!(age <= kForgotten)) continue;
    const QColor& colour = age > 0.0 ? kOldFeatureColour : kFeatureColour;
    QRectF box;
    const std::vector<FeatureFact>& all = tracker.drawn->features;
    for (const FeatureFact& feature : all) box = box.united(drawFeature(painter, feature, letterbox, colour));
    const bool few = std::count_if(all.begin(), all.end(), isDrawn) <= static_cast<std::ptrdiff_t>(kFewFeatures);
    const FeatureFact* at_mouse = featureAt(*tracker.drawn, letterbox, mouse);
    for (const FeatureFact& feature : all) {  // over all the forms
      if (isDrawn(feature) && (few || &feature == at_mouse))
        drawWords(painter, letterbox.area(), labelOf(feature, letterbox), QString::fromStdString(feature.id), colour);
    }
    if (age > kOldest && !box.isNull())
      drawWords(painter, letterbox.area(), (box & letterbox.area()).center(),
                QString("%1: %2 s old").arg(QString::fromStdString(tracker.name)).arg(age, 0, 'f', 1), Qt::white);
  }
  painter.restore();
}

void drawFeatureLegend(QPainter& painter, const QRectF& canvas) {
  constexpr double kLegend = 234.0;  // px, width
  if (canvas.width() < kLegend + kLegendWidth + 2.0 * Legend::kMargin) return;
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  Legend legend(painter, canvas, Legend::Corner::kRight, kLegend, 6);
  const auto next = [&legend](const QString& words) {
    const QRectF sample = legend.next(words);
    const double middle = sample.center().y();
    return QPolygonF(QVector<QPointF>{{sample.left(), middle}, {sample.right(), middle}});
  };
  const Look seen{kFeatureColour}, expected{kFeatureColour, Qt::DotLine};
  const QPolygonF edge = next("edge or outline, as it is seen");
  stroke(painter, edge, seen);
  drawBars(painter, edge, seen);
  stroke(painter, next("where it is looked for"), expected);
  const QPolygonF mark = next("point, dot, tip");
  drawMark(painter, (mark[0] + mark[1]) / 2, seen);
  drawArrow(painter, next("axis of an instrument"), seen);
  const QPolygonF band = next("twice the expected error");
  takeVeil(painter, kFeatureColour);
  painter.drawRect(QRectF(band[0] - QPointF(0, 4), band[1] + QPointF(0, 4)));
  stroke(painter, next("of an earlier picture"), {kOldFeatureColour});
  painter.restore();
}

}  // namespace laparoscope_servo::screen
