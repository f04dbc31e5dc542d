// A control that moves the scope only while a hand holds it: the dead-man switch, a slider.
//
// The GUI's thread reports presses and releases, and regular beats. The sending thread reads whether it is held. A hung
// GUI cannot report a release, so its silence ends the hold. After that the control must be pressed again. `now` is s
// of a steady clock. Thread-safe.
#pragma once

#include <mutex>

namespace laparoscope_servo::screen {

// s, allowed silence of the GUI: four of its beats, since a busy machine may delay one or two.
constexpr double kPatience = 0.2;

class HeldControl {
 public:
  void take(double now);
  void letGo();
  // Call when the GUI has found the control still held.
  void beat(double now);
  bool isHeld(double now);

 private:
  std::mutex mutex_;
  bool held_ = false;
  double beat_ = 0.0;
};

}  // namespace laparoscope_servo::screen
