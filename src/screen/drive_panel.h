// The page of the screen on which the task is chosen, and the scope driven by hand.
#pragma once

#include <QPushButton>
#include <QWidget>
#include <array>

#include "screen/ros_link.h"
#include "screen/velocity_slider.h"

namespace laparoscope_servo::screen {

class DrivePanel : public QWidget {
  Q_OBJECT
 public:
  DrivePanel(RosLink& link, QWidget* parent);

  void show(const Facts& facts);
  // Call 20 times a second: a slider that is held ends by itself otherwise.
  void beat();
  // Ends what is held.
  void letGo();

 private:
  void passShares();

  RosLink& link_;
  QPushButton* follow_;
  QPushButton* drive_;
  std::array<VelocitySlider*, 4> sliders_{};
};

}  // namespace laparoscope_servo::screen
