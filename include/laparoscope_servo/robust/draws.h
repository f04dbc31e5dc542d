// Repeatable random numbers, to draw samples from which a robust estimate starts: no global state, no clock.
#pragma once

#include <cstddef>
#include <cstdint>

namespace laparoscope_servo::robust {

// A linear congruential generator (Knuth's constants of MMIX); every object gives the same numbers.
class Draws {
 public:
  // 0 to count - 1, `count` from 1 to 2^31.
  std::size_t below(std::size_t count) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::size_t>((state_ >> 33) % count);
  }

 private:
  std::uint64_t state_ = 1;
};

}  // namespace laparoscope_servo::robust
