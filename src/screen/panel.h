// The screen as a panel of rviz: laparoscope_servo/Laparoscope.
#pragma once

#include <rviz/panel.h>

namespace laparoscope_servo::screen {

class Panel : public rviz::Panel {
  Q_OBJECT
 public:
  explicit Panel(QWidget* parent = nullptr);
};

}  // namespace laparoscope_servo::screen
