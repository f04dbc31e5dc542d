// Detects whether a key is held in spite of X11's key repeat: pairs of a release and a press, of which Qt marks only
// some as repeated. A release counts if no press follows within a moment.
#pragma once

namespace laparoscope_servo::screen {

// s. The two events of a pair are sent together; a hand that releases and presses again takes longer.
constexpr double kRepeatGap = 0.02;

class KeyHold {
 public:
  // `now`: s, steady. Returns true if the key was not held before.
  bool press();
  void release(double now);
  // Call kRepeatGap after a release. Returns true if it was a real one.
  bool released(double now);
  void forget() { down_ = releasing_ = false; }
  bool isDown() const { return down_; }

 private:
  bool down_ = false;
  bool releasing_ = false;
  double released_at_ = 0.0;
};

}  // namespace laparoscope_servo::screen
