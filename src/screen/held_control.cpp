#include "screen/held_control.h"

namespace laparoscope_servo::screen {

void HeldControl::take(double now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  held_ = true;
  beat_ = now;
}

void HeldControl::letGo() {
  const std::lock_guard<std::mutex> lock(mutex_);
  held_ = false;
}

void HeldControl::beat(double now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  // A beat after too long a silence does not restore the hold that the silence has ended.
  if (held_ && !(now - beat_ <= kPatience)) held_ = false;
  beat_ = now;
}

bool HeldControl::isHeld(double now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (held_ && !(now - beat_ <= kPatience)) held_ = false;
  return held_;
}

}  // namespace laparoscope_servo::screen
