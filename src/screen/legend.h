// What is drawn over the picture, each form with its words: rows in a dark box.
#pragma once

#include <QPainter>
#include <QRectF>
#include <QString>

namespace laparoscope_servo::screen {

class Legend {
 public:
  enum class Corner { kLeft, kRight };
  static constexpr double kMargin = 6.0;  // px, from the side of the canvas

  // At the bottom of `canvas`; `width`: px. Changes the painter's font.
  Legend(QPainter& painter, const QRectF& canvas, Corner corner, double width, int rows);

  // Writes the words of the next row; where its sample is to be drawn. Changes the pen.
  QRectF next(const QString& words);

 private:
  QPainter& painter_;
  QRectF box_;
  int row_ = 0;
};

}  // namespace laparoscope_servo::screen
