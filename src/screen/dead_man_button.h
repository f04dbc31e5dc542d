// The dead-man switch: held by the mouse, or by a key that the screen passes on.
#pragma once

#include <QString>

#include "screen/hold_area.h"
#include "screen/key_hold.h"

namespace laparoscope_servo::screen {

class DeadManButton : public HoldArea {
  Q_OBJECT
 public:
  DeadManButton(HeldControl& control, const std::function<void()>& changed, QWidget* parent);

  // Whether a node subscribes to the switch.
  void setWanted(bool wanted);
  void keyPressed();
  void keyReleased();
  QSize sizeHint() const override { return {200, 48}; }

 private:
  void paintEvent(QPaintEvent* event) override;
  QString obstacle() const override;

  bool wanted_ = false;
  KeyHold key_;
};

}  // namespace laparoscope_servo::screen
