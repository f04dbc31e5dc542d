#include "screen/key_hold.h"

namespace laparoscope_servo::screen {

bool KeyHold::press() {
  releasing_ = false;
  const bool newly = !down_;
  down_ = true;
  return newly;
}

void KeyHold::release(double now) {
  if (!down_) return;
  releasing_ = true;
  released_at_ = now;
}

bool KeyHold::released(double now) {
  if (!releasing_ || now - released_at_ < kRepeatGap) return false;
  forget();
  return true;
}

}  // namespace laparoscope_servo::screen
