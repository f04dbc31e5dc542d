#include "ros/common/hold_words.h"

namespace laparoscope_servo {

namespace {

constexpr int kReleases = 3;  // cycles, as for kFarewellZeros

}  // namespace

std::vector<bool> DeadManWords::turn(bool held) {
  const bool taken = held && !was_held_;
  if (was_held_ && !held) farewells_ = kReleases;
  was_held_ = held;
  if (taken) return {false, true};
  if (held) return {true};
  if (farewells_ == 0) return {};
  --farewells_;
  return {false};
}

SliderWords::Word SliderWords::turn(bool held, double now) {
  if (held && !was_held_) taken_at_ = now;
  was_held_ = held;
  if (held) farewells_ = kFarewellZeros;
  if (held) return now - taken_at_ < kRest ? Word::kZero : Word::kValue;
  if (farewells_ == 0) return Word::kNothing;
  --farewells_;
  return Word::kZero;
}

}  // namespace laparoscope_servo
