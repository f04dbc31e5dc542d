// Something that moves the scope only while a hand holds it: the dead-man switch, a slider.
//
// The GUI's thread says when the hand takes and lets go, and that it is alive. The thread that sends asks whether it is
// held: a GUI that hangs cannot say that the hand has let go, so that its silence ends the hold. What has ended has to
// be taken anew. `now` is s of a steady clock. Thread-safe.
#pragma once

#include <mutex>

namespace laparoscope_servo::screen {

// s that the GUI may be silent: four of its beats. A busy machine delays one or two.
constexpr double kPatience = 0.2;

class HeldControl {
 public:
  void take(double now);
  void letGo();
  // The GUI has just seen that it is still held.
  void beat(double now);
  bool isHeld(double now);

 private:
  std::mutex mutex_;
  bool held_ = false;
  double beat_ = 0.0;
};

}  // namespace laparoscope_servo::screen
