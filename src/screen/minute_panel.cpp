#include "screen/minute_panel.h"

#include <QPainter>
#include <algorithm>

namespace laparoscope_servo::screen {

namespace {

struct Plot {
  const char* name;
  const char* unit;
  double scale;  // factor from SI to the unit
  double top;    // least top of the axis, in the unit
  int decimals;
};
const Plot kPlots[kQuantities] = {{"confidence", "", 1.0, 1.0, 2},
                                  {"corner error", " px", 1.0, 2.0, 2},
                                  {"visible", " %", 100.0, 100.0, 0},
                                  {"rate", " Hz", 1.0, 30.0, 0},
                                  {"delay", " ms", 1000.0, 100.0, 0}};
const QColor kBackground(0x16, 0x1a, 0x20);
const QColor kLine(0x7f, 0xd4, 0xff);
const QColor kLost(0x80, 0x40, 0x40);
const QColor kLimit(0xff, 0x90, 0x40);
constexpr double kWords = 142.0;  // px, left of the plots

QString number(double value, const Plot& plot) {
  return QString::number(value, 'f', plot.decimals) + plot.unit;
}

}  // namespace

MinutePanel::MinutePanel(QWidget* parent) : QWidget(parent) {
  setObjectName("minute");
  setAttribute(Qt::WA_OpaquePaintEvent);
}

void MinutePanel::show(const std::vector<MinuteHistory::Step>& steps, const Limits& limits) {
  steps_ = steps;
  limits_ = limits;
  update();
}

void MinutePanel::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), kBackground);
  const double height = static_cast<double>(this->height()) / kQuantities;
  for (int quantity = 0; quantity < kQuantities; ++quantity)
    drawPlot(painter, quantity, QRectF(0, quantity * height, width(), height).adjusted(2, 2, -2, -2));
}

void MinutePanel::drawPlot(QPainter& painter, int quantity, const QRectF& area) const {
  const Plot& plot = kPlots[quantity];
  const Limit& limit = limits_[static_cast<std::size_t>(quantity)];
  const QRectF field = area.adjusted(kWords, 0, 0, 0);
  painter.fillRect(field, QColor(0x0c, 0x0e, 0x12));
  double top = std::max(plot.top, 1.25 * plot.scale * limit.value);
  const MinuteHistory::Range* last = nullptr;
  for (const MinuteHistory::Step& step : steps_) {
    const MinuteHistory::Range& range = step.ranges[static_cast<std::size_t>(quantity)];
    if (!range.known) continue;
    top = std::max(top, plot.scale * range.high);
    last = &range;
  }
  const auto y = [&](double value) {
    return field.bottom() - field.height() * std::clamp(plot.scale * value / top, 0.0, 1.0);
  };
  const double width = field.width() / MinuteHistory::kSteps;
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const MinuteHistory::Range& range = steps_[k].ranges[static_cast<std::size_t>(quantity)];
    const double left = field.left() + static_cast<double>(k) * width;
    if (steps_[k].images > 0 && !steps_[k].tracked)
      painter.fillRect(QRectF(left, field.bottom() - 3, width + 0.5, 3), kLost);
    if (!range.known) continue;
    const double high = y(range.high);
    painter.fillRect(QRectF(left, high - 1, width + 0.5, y(range.low) - high + 2), kLine);
  }
  QString words;
  if (limit.value >= 0.0) {
    painter.setPen(QPen(kLimit, 1, Qt::DashLine));
    painter.drawLine(QPointF(field.left(), y(limit.value)), QPointF(field.right(), y(limit.value)));
    words = QString(limit.at_least ? "at least " : "at most ") + number(plot.scale * limit.value, plot);
  }
  QFont font = painter.font();
  font.setPixelSize(12);
  painter.setFont(font);
  const QRectF text = QRectF(area.left(), area.top(), kWords - 6, area.height());
  painter.setPen(Qt::white);
  painter.drawText(text, Qt::AlignLeft | Qt::AlignTop, plot.name);
  painter.setPen(kLimit);
  painter.drawText(text, Qt::AlignLeft | Qt::AlignBottom, words);
  painter.setPen(kLine);
  const double now = last == nullptr ? 0.0 : quantity == kConfidence || quantity == kVisible ? last->low : last->high;
  painter.drawText(text, Qt::AlignRight | Qt::AlignTop, last == nullptr ? "-" : number(plot.scale * now, plot));
}

}  // namespace laparoscope_servo::screen
