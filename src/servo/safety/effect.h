// Result of comparing the picture's motion with the scope's, see effect_guard.h.
#pragma once

namespace laparoscope_servo::servo {

enum class Effect {
  kAsCommanded,  // no evidence of a fault
  kDoubted,      // a fault explains the images better: the scope stops while this holds
  kWrong,        // a fault explains the images so much better that an operator must look at the arm first
};

}  // namespace laparoscope_servo::servo
