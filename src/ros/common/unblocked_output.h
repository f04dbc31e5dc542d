// Makes printing non-blocking: a terminal stopped by Ctrl-S, a pipe that nobody reads or a slow ssh connection would
// otherwise block the thread that logs, and with it the loop that controls the arm.
//
// Standard output and standard error become pipes. One thread moves the text from the pipe to a bounded queue, another
// one writes the queue to the original target and may block. This covers all output of the process, also of roscpp and
// other libraries. If the queue is full, whole lines are dropped and counted, and the number is printed when there is
// room again. The order of lines is kept, also across both streams if they have the same target.
//
// The last lines are printed too: the destructor, exit() and the handlers of crash signals wait until all is written,
// but not longer than a second. SIGKILL loses what was printed in the last milliseconds.
#pragma once

#include <cstddef>
#include <cstdint>

namespace laparoscope_servo {

class UnblockedOutput {
 public:
  // Construct it once, first in main(). On failure output stays as it was, with a message on stderr.
  UnblockedOutput();
  ~UnblockedOutput();
  UnblockedOutput(const UnblockedOutput&) = delete;
  UnblockedOutput& operator=(const UnblockedOutput&) = delete;
};

// Waits until all is written, but not longer than a second.
void flushOutput();

// Number of dropped lines since the start.
std::uint64_t droppedLogLines();

}  // namespace laparoscope_servo
