// Messages of a control that a hand holds, for each cycle of the publishing thread.
#pragma once

#include <vector>

namespace laparoscope_servo {

// Cycles of 0.05 s for which zero is published after a stick was released. A lost message does no harm, since silence
// also ends the motion, a moment later.
constexpr int kFarewellZeros = 10;

// The dead-man switch. It publishes nothing while nobody holds it, because a "false" of any publisher also stops the
// holder of another switch.
class DeadManWords {
 public:
  // The messages to publish now, in this order. A "false" precedes the first "true", because the controller accepts
  // only a switch that it has seen released since engaging.
  std::vector<bool> turn(bool held);
  bool isHeld() const { return was_held_; }  // whether it was held in the last cycle

 private:
  bool was_held_ = false;
  int farewells_ = 0;
};

// Sliders: their velocity while held, then zero for a moment, then nothing. Zero comes first, because the controller
// accepts only a stick that it has seen at rest; and stays for kRest, since the controller looks at the newest message
// only, once in a cycle.
class SliderWords {
 public:
  enum class Word { kNothing, kZero, kValue };
  static constexpr double kRest = 0.1;  // s: a cycle of the slowest controller (parameter rate)
  // `now`: s.
  Word turn(bool held, double now);

 private:
  bool was_held_ = false;
  double taken_at_ = 0.0;  // s
  int farewells_ = 0;
};

}  // namespace laparoscope_servo
