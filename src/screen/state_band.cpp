#include "screen/state_band.h"

#include <QPainter>

#include "screen/fitted_text.h"
#include "screen/level_symbol.h"

namespace laparoscope_servo::screen {

namespace {

constexpr int kStripe = 44;       // px, with the symbol
constexpr double kSymbol = 13.0;  // px, radius
constexpr int kWordSize = 56;     // px, size of the font; its capitals are 41 px high
constexpr int kWordTop = 14;      // px, from the top of the band to the word's line
constexpr int kWordHeight = 56;
constexpr int kMargin = 6;     // px, beside a long word: condensed letters are up to a pixel wider than their measure
constexpr int kTextSize = 13;  // px of the font
constexpr int kSmallestText = 10;  // px of the font, of a text that is too long otherwise
constexpr int kLine = 16;          // px

const QColor kBackground(0x16, 0x1a, 0x20);
const QColor kText(0xff, 0xff, 0xff);
const QColor kQuiet(0xb4, 0xbc, 0xc8);

}  // namespace

StateBand::StateBand(const QString& title, QWidget* parent) : QWidget(parent), title_(title) {
  setObjectName(title);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

QSize StateBand::sizeHint() const {
  return {400, kWordTop + kWordHeight + 4 * kLine + 4};
}

void StateBand::show(const BandText& text) {
  if (text == text_) return;
  text_ = text;
  // Escaped, since a node's text may look like markup.
  setToolTip(QString::fromStdString(text.detail).toHtmlEscaped());
  update();
}

void StateBand::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.fillRect(rect(), kBackground);
  painter.fillRect(QRect(0, 0, kStripe, height()), levelColour(text_.level));
  drawLevelSymbol(painter, text_.level, QPointF(kStripe / 2.0, kWordTop + kWordHeight / 2.0), kSymbol);
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(QColor(0x40, 0x46, 0x50), 1));
  painter.drawRect(rect().adjusted(0, 0, -1, -1));

  const int left = kStripe + 10;
  const int width = this->width() - left - 6;
  QFont font = this->font();
  font.setPixelSize(12);
  font.setBold(true);
  painter.setFont(font);
  painter.setPen(kQuiet);
  const QRect head(left, 2, width, 15);
  painter.drawText(head, Qt::AlignLeft | Qt::AlignVCenter, title_.toUpper());
  if (!text_.note.empty()) {
    painter.setPen(kText);
    painter.drawText(head, Qt::AlignRight | Qt::AlignVCenter, QString::fromStdString(text_.note));
  }

  font.setPixelSize(kWordSize);
  const QString word = QString::fromStdString(text_.word);
  // A long word is condensed horizontally, but keeps its height.
  const int natural = QFontMetrics(font).horizontalAdvance(word);
  if (natural > width - kMargin) font.setStretch(std::max(40, 100 * (width - kMargin) / natural));
  painter.setFont(font);
  painter.setPen(kText);
  painter.drawText(QRect(left, kWordTop, width, kWordHeight), Qt::AlignLeft | Qt::AlignVCenter, word);

  font = this->font();
  font.setPixelSize(kTextSize);
  const int top = kWordTop + kWordHeight + 2;
  const int half = 2 * kLine;
  font.setBold(true);
  drawFitted(painter, QRectF(left, top, width, half), QString::fromStdString(text_.sentence), font, kSmallestText);
  font.setBold(false);
  painter.setPen(kQuiet);
  drawFitted(painter, QRectF(left, top + half, width, half), QString::fromStdString(text_.cure), font, kSmallestText);
}

}  // namespace laparoscope_servo::screen
