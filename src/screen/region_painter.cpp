#include "screen/region_painter.h"

#include <algorithm>

#include "ros/reasons/reason_table.h"

namespace laparoscope_servo::screen {

namespace {

const QColor kTaken(0x5c, 0xf0, 0x8c);
const QColor kRefused(0xff, 0x70, 0x60);

void drawTick(QPainter& painter, const QPointF& at) {
  painter.drawPolyline(QPolygonF({at + QPointF(-7, 0), at + QPointF(-2, 6), at + QPointF(8, -7)}));
}

void drawCross(QPainter& painter, const QPointF& at) {
  painter.drawLine(at + QPointF(-6, -6), at + QPointF(6, 6));
  painter.drawLine(at + QPointF(-6, 6), at + QPointF(6, -6));
}

enum class Mark { kNone, kTick, kCross };

// Above the outline, or below it, within `canvas`: white in a dark box, as wide as the words need and the canvas
// allows.
void drawLabel(QPainter& painter, const QRectF& outline, const QRectF& canvas, const QString& text, Mark mark,
               const QColor& colour) {
  QFont font = painter.font();
  font.setPixelSize(15);
  font.setBold(true);
  painter.setFont(font);
  constexpr double kSides = 14.0, kMark = 26.0, kLine = 20.0, kSpare = 4.0;
  const double left_of_text = mark == Mark::kNone ? 8.0 : kMark;
  const double room = std::max(80.0, canvas.width() - left_of_text - kSides);
  const QRectF wrapped = QFontMetricsF(font).boundingRect(QRectF(0, 0, room, 1e4), Qt::TextWordWrap, text);
  const double width = std::min(wrapped.width() + left_of_text + kSides, canvas.width());
  const double height = std::max(kLine, wrapped.height()) + kSpare;
  const double left = std::clamp(outline.left(), canvas.left(), std::max(canvas.left(), canvas.right() - width));
  const double above = outline.top() - height - 4.0;
  const double top = above >= canvas.top() ? above : std::min(outline.bottom() + 4.0, canvas.bottom() - height);
  const QRectF label(left, top, width, height);
  painter.fillRect(label, QColor(0, 0, 0, 200));
  painter.setPen(QPen(colour, 3, Qt::SolidLine, Qt::RoundCap));
  painter.setBrush(Qt::NoBrush);
  const QPointF at(label.left() + 14, label.center().y());
  if (mark == Mark::kTick) drawTick(painter, at);
  if (mark == Mark::kCross) drawCross(painter, at);
  painter.setPen(Qt::white);
  painter.drawText(label.adjusted(left_of_text, 0, -4, 0), Qt::AlignLeft | Qt::AlignVCenter | Qt::TextWordWrap, text);
}

}  // namespace

QString wordsOf(const Verdict& verdict) {
  if (verdict.taken) return "The tracker would take it.";
  const ReasonRow* row = explain(Speaker::kTracker, verdict.why);
  const QString words = QString::fromStdString(row != nullptr ? row->sentence + " " + row->cure : verdict.why);
  return verdict.proposal.isEmpty() ? words : words + " The dotted one would do.";
}

void drawProposal(QPainter& painter, const QRectF& outline) {
  painter.save();
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(Qt::black, 4));
  painter.drawRect(outline);
  painter.setPen(QPen(kTaken, 2, Qt::DotLine));
  painter.drawRect(outline);
  painter.restore();
}

void drawRegion(QPainter& painter, const QRectF& outline, const QRect& pixels, const Verdict* verdict, bool by_keys,
                const QRectF& canvas) {
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setBrush(QColor(255, 255, 255, 30));
  painter.setPen(QPen(Qt::black, 4));
  painter.drawRect(outline);
  const bool refused = verdict != nullptr && !verdict->taken;
  const QColor colour = verdict == nullptr ? QColor(Qt::white) : refused ? kRefused : kTaken;
  painter.setPen(QPen(colour, 2, refused ? Qt::DashLine : Qt::SolidLine));
  painter.drawRect(outline);
  QString text =
      QString("%1 x %2 px at %3, %4. ").arg(pixels.width()).arg(pixels.height()).arg(pixels.x()).arg(pixels.y());
  text += verdict == nullptr ? "The tracker is asked ..." : wordsOf(*verdict);
  if (by_keys) text += " Return selects it.";
  drawLabel(painter, outline, canvas, text,
            verdict == nullptr ? Mark::kNone
            : refused          ? Mark::kCross
                               : Mark::kTick,
            colour);
  painter.restore();
}

void drawOffer(QPainter& painter, const QRectF& outline, const Offer& offer, const QRectF& canvas) {
  painter.save();
  drawProposal(painter, outline);
  drawLabel(painter, outline, canvas,
            QString(offer.not_held ? "The region could not be held. This one would do" : "This one would do") +
                ": click in it, or press Return.",
            Mark::kTick, kTaken);
  painter.restore();
}

}  // namespace laparoscope_servo::screen
