#include "screen/legend.h"

namespace laparoscope_servo::screen {

namespace {

constexpr double kBottom = 4.0;   // px, from the bottom of the canvas
constexpr double kBorder = 4.0;   // px, above the first row and below the last one
constexpr double kRow = 16.0;     // px, height
constexpr double kSample = 34.0;  // px, width
constexpr double kGap = 8.0;      // px, on either side of a sample

}  // namespace

Legend::Legend(QPainter& painter, const QRectF& canvas, Corner corner, double width, int rows) : painter_(painter) {
  const double height = rows * kRow + 2.0 * kBorder;
  const double left = corner == Corner::kLeft ? canvas.left() + kMargin : canvas.right() - width - kMargin;
  box_ = QRectF(left, canvas.bottom() - height - kBottom, width, height);
  painter_.fillRect(box_, QColor(0, 0, 0, 170));
  QFont font = painter_.font();
  font.setPixelSize(12);
  font.setBold(false);
  painter_.setFont(font);
}

QRectF Legend::next(const QString& words) {
  const QRectF sample(box_.left() + kGap, box_.top() + kBorder + kRow * row_++, kSample, kRow);
  painter_.setPen(Qt::white);
  painter_.drawText(QRectF(sample.right() + kGap, sample.top(), box_.width(), kRow), Qt::AlignLeft | Qt::AlignVCenter,
                    words);
  return sample;
}

}  // namespace laparoscope_servo::screen
