// Whether a key is held, from the presses and releases that come while X11 repeats it: pairs of a release and a press,
// of which Qt marks some as repeated and some not. A release counts when no press follows it for a moment.
#pragma once

namespace laparoscope_servo::screen {

// s. The two events of a pair are sent together; a hand that lets go and presses again takes longer.
constexpr double kRepeatGap = 0.03;

class KeyHold {
 public:
  // `now`: s, steady. True: the key is newly held.
  bool press();
  void release(double now);
  // To be called kRepeatGap after a release. True: it was one.
  bool released(double now);
  void forget() { down_ = releasing_ = false; }
  bool isDown() const { return down_; }

 private:
  bool down_ = false;
  bool releasing_ = false;
  double released_at_ = 0.0;
};

}  // namespace laparoscope_servo::screen
