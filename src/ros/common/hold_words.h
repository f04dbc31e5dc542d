// What a held control says on its topic, at each turn of the thread that sends.
#pragma once

#include <vector>

namespace laparoscope_servo {

// Turns of 0.05 s, in which a stick that was let go says zero. A word that is lost on its way does no harm: silence
// ends the motion as well, a moment later.
constexpr int kFarewellZeros = 10;

// The dead-man switch. It is silent while nobody holds it, for a false from anywhere stops who holds another one.
class DeadManWords {
 public:
  // To publish now, in this order. A false comes before the first true: the controller believes only a switch that it
  // has seen released since it was engaged, which is so when a hand takes it anew.
  std::vector<bool> turn(bool held);
  bool isHeld() const { return was_held_; }  // at the last turn

 private:
  bool was_held_ = false;
  int farewells_ = 0;
};

// Sliders: what they say while held, then zero for a moment, then nothing. The first word is a zero: the controller
// obeys a stick only that it has seen at rest.
class SliderWords {
 public:
  enum class Word { kNothing, kZero, kValue };
  Word turn(bool held);

 private:
  bool was_held_ = false;
  int farewells_ = 0;
};

}  // namespace laparoscope_servo
