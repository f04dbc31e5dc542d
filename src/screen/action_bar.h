// The row of buttons below the picture: what may be done with arm, controller and region, and STOP.
#pragma once

#include <QWidget>
#include <functional>

#include "screen/ros_link.h"

namespace laparoscope_servo::screen {

class ActionBar : public QWidget {
  Q_OBJECT
 public:
  // `stop` is called on the press of STOP, not on its release.
  ActionBar(RosLink& link, const std::function<void()>& stop, QWidget* parent);
};

}  // namespace laparoscope_servo::screen
