// One band: a word readable from afar, a sentence, and what to do. Opaque and of fixed height, so that its text does
// not move the widgets below.
#pragma once

#include <QWidget>

#include "screen/band_text.h"

namespace laparoscope_servo::screen {

class StateBand : public QWidget {
  Q_OBJECT
 public:
  StateBand(const QString& title, QWidget* parent);

  void show(const BandText& text);
  const BandText& text() const { return text_; }
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return sizeHint(); }

 private:
  void paintEvent(QPaintEvent* event) override;

  QString title_;
  BandText text_;
};

}  // namespace laparoscope_servo::screen
