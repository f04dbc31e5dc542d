// A label whose size does not depend on its text, so that a longer text moves nothing that is under the mouse.
#pragma once

#include <QLabel>

namespace laparoscope_servo::screen {

class FittedLabel : public QLabel {
  Q_OBJECT
 public:
  // `least`, `most`: px of its height. As wide as its layout makes it.
  FittedLabel(const QString& name, int least, int most, QWidget* parent);

  // Also the tool tip, which has all of a text that is too long even for the smallest font.
  void say(const QString& words);
  QSize sizeHint() const override { return {0, maximumHeight()}; }
  QSize minimumSizeHint() const override { return {0, minimumHeight()}; }

 private:
  void paintEvent(QPaintEvent* event) override;
};

}  // namespace laparoscope_servo::screen
