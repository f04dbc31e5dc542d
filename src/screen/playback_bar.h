// Playback controls: play, pause, step, again, and the position. Hidden when no player runs.
#pragma once

#include <QLabel>
#include <QPushButton>
#include <QSlider>
#include <QWidget>
#include <functional>
#include <string>

#include "screen/facts.h"

namespace laparoscope_servo::screen {

class PlaybackBar : public QWidget {
  Q_OBJECT
 public:
  // `command` and `position` [s] of ControlPlayback.
  using Control = std::function<void(const std::string& command, double position)>;
  PlaybackBar(const Control& control, QWidget* parent);

  void show(const PlaybackFacts& facts);

 private:
  QPushButton* makeButton(const QString& name, const QString& tip, const std::function<void()>& act);

  Control control_;
  PlaybackFacts facts_;
  QPushButton* play_;
  QSlider* place_;
  QLabel* words_;
};

}  // namespace laparoscope_servo::screen
