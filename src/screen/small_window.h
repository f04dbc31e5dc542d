// The window on a display that is too small for the screen, as a scale of 200 % makes it: the screen is scrolled, and
// STOP stays in sight.
#pragma once

#include <QWidget>

#include "screen/screen_widget.h"

namespace laparoscope_servo::screen {

class SmallWindow : public QWidget {
  Q_OBJECT
 public:
  // Takes the screen.
  explicit SmallWindow(ScreenWidget* screen);
};

}  // namespace laparoscope_servo::screen
