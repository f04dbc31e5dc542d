#include "screen/hold_words.h"

namespace laparoscope_servo::screen {

namespace {

// Turns of 0.05 s. One that is lost on its way does no harm: silence ends the hold as well, a moment later.
constexpr int kReleases = 3;
constexpr int kZeros = 10;

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

SliderWords::Word SliderWords::turn(bool held) {
  const bool taken = held && !was_held_;
  was_held_ = held;
  if (held) farewells_ = kZeros;
  if (held) return taken ? Word::kZero : Word::kValue;
  if (farewells_ == 0) return Word::kNothing;
  --farewells_;
  return Word::kZero;
}

}  // namespace laparoscope_servo::screen
