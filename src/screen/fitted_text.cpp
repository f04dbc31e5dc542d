#include "screen/fitted_text.h"

#include <QFontMetricsF>
#include <QTextLayout>

namespace laparoscope_servo::screen {

namespace {

// Breaks the text into lines of this width; false: they are higher than `height`.
bool layOut(QTextLayout& layout, const QFont& font, double width, double height) {
  QTextOption option;
  option.setWrapMode(QTextOption::WrapAtWordBoundaryOrAnywhere);
  layout.setTextOption(option);
  layout.setFont(font);
  double bottom = 0.0;
  layout.beginLayout();
  for (QTextLine line = layout.createLine(); line.isValid(); line = layout.createLine()) {
    line.setLineWidth(width);
    line.setPosition({0.0, bottom});
    bottom += line.height();
    if (bottom > height) break;
  }
  layout.endLayout();
  return bottom <= height;
}

}  // namespace

void drawFitted(QPainter& painter, const QRectF& area, const QString& text, QFont font, int smallest) {
  QTextLayout layout(QString(text).replace('\n', QChar::LineSeparator));
  int size = font.pixelSize();
  bool all = layOut(layout, font, area.width(), area.height());
  while (!all && size > smallest) {
    font.setPixelSize(--size);
    all = layOut(layout, font, area.width(), area.height());
  }
  // The one line too many is left out, and the last one that is drawn ends with "…".
  const int drawn = all ? layout.lineCount() : layout.lineCount() - 1;
  for (int k = 0; k < drawn - (all ? 0 : 1); ++k) layout.lineAt(k).draw(&painter, area.topLeft());
  if (all || drawn < 1) return;
  const QTextLine last = layout.lineAt(drawn - 1);
  const QString rest = layout.text().mid(last.textStart()).replace(QChar::LineSeparator, ' ');
  painter.setFont(font);
  painter.drawText(QPointF(area.left(), area.top() + last.y() + last.ascent()),
                   QFontMetricsF(font).elidedText(rest, Qt::ElideRight, area.width()));
}

}  // namespace laparoscope_servo::screen
