// Time that this thread has spent computing: on a machine that others use too, what they take does not count.
#pragma once

#include <time.h>

namespace laparoscope_servo::bench {

// s
inline double cpuTime() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace laparoscope_servo::bench
