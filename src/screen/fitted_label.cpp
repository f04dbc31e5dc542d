#include "screen/fitted_label.h"

#include "screen/fitted_text.h"

namespace laparoscope_servo::screen {

namespace {

constexpr int kLargest = 14;   // px of the font
constexpr int kSmallest = 11;  // px of the font

}  // namespace

FittedLabel::FittedLabel(const QString& name, int least, int most, QWidget* parent) : QLabel(parent) {
  setObjectName(name);
  setTextFormat(Qt::PlainText);
  setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  setMinimumHeight(least);
  setMaximumHeight(most);
}

void FittedLabel::say(const QString& words) {
  if (words == text()) return;
  setText(words);
  setToolTip(words.toHtmlEscaped());
}

void FittedLabel::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setPen(Qt::white);
  QFont font = this->font();
  font.setPixelSize(kLargest);
  drawFitted(painter, rect(), text(), font, kSmallest);
}

}  // namespace laparoscope_servo::screen
