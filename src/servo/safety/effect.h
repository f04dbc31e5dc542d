// What the picture says of the scope's motion, see effect_guard.h.
#pragma once

namespace laparoscope_servo::servo {

enum class Effect {
  kAsCommanded,  // nothing speaks against it
  kDoubted,      // a fault is the better explanation: the scope stands until it is not
  kWrong,        // by so much that somebody has to look before it goes on
};

}  // namespace laparoscope_servo::servo
