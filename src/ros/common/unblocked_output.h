// What the process prints never makes it wait: a terminal stopped by Ctrl-S, a pipe that nobody reads and a slow ssh
// connection would otherwise hold whoever logs, and with it the loop that controls the arm.
//
// Standard output and standard error become pipes. One thread takes what is printed out of the pipe into a bounded
// queue, another one writes the queue to where it belongs and may wait for ever. This catches every writer in the
// process, also roscpp's own and the libraries'. What finds the queue full is dropped, in whole lines, counted, and
// said when there is room again. The order of lines is kept, across both streams where they go to the same place.
//
// What is printed last comes out, too: the end of the scope, exit() and the signals of a crash wait until all is
// written, but not longer than a second. SIGKILL loses what was printed in the last milliseconds.
#pragma once

#include <cstddef>
#include <cstdint>

namespace laparoscope_servo {

class UnblockedOutput {
 public:
  // To be made once, first thing in main(). Where it cannot be had, everything stays as it was, and stderr says so.
  UnblockedOutput();
  ~UnblockedOutput();
  UnblockedOutput(const UnblockedOutput&) = delete;
  UnblockedOutput& operator=(const UnblockedOutput&) = delete;
};

// Waits until all is written, but not longer than a second.
void flushOutput();

// Since the start.
std::uint64_t droppedLogLines();

}  // namespace laparoscope_servo
