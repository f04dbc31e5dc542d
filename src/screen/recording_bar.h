// A line below the picture that says whether a case is recorded, and why not. It is there only with a recorder.
#pragma once

#include <QWidget>

#include "screen/band_text.h"

namespace laparoscope_servo::screen {

// The word is empty where there is nothing to be said of a recorder.
BandText recordingText(const RecorderFacts& recorder, double now);

class RecordingBar : public QWidget {
  Q_OBJECT
 public:
  explicit RecordingBar(QWidget* parent);

  void show(const BandText& text);
  const BandText& text() const { return text_; }

 private:
  void paintEvent(QPaintEvent* event) override;

  BandText text_;
};

}  // namespace laparoscope_servo::screen
