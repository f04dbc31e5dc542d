// The page of the screen on which the task is chosen, and the scope driven by hand.
#pragma once

#include <QPushButton>
#include <QWidget>
#include <array>
#include <vector>

#include "screen/fitted_label.h"
#include "screen/ros_link.h"
#include "screen/task_words.h"
#include "screen/velocity_slider.h"

namespace laparoscope_servo::screen {

class DrivePanel : public QWidget {
  Q_OBJECT
 public:
  DrivePanel(RosLink& link, QWidget* parent);

  void show(const Facts& facts, double now);
  // Call 20 times a second: a slider that is held ends by itself otherwise.
  void beat();
  // Ends what is held.
  void letGo();

 private:
  bool eventFilter(QObject* object, QEvent* event) override;
  void passShares();
  void tellTask();

  RosLink& link_;
  std::vector<QPushButton*> tasks_;  // in the order of taskWords()
  FittedLabel* promise_;
  QPushButton* keep_view_;
  std::array<VelocitySlider*, 4> sliders_{};
  ControllerFacts controller_;             // without a task while it is silent
  const TaskWords* pointed_at_ = nullptr;  // the task whose button is under the mouse
};

}  // namespace laparoscope_servo::screen
