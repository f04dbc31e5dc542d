// The clock of a machine that somebody sets, for the processes that a test starts: a library in front of theirs adds to
// what the real clock says. The test's own clock stays right.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>

#include "support/temporary_folder.h"

namespace laparoscope_servo::test {

class SteppedClock {
 public:
  // Of processes that are started from now on.
  SteppedClock() {
    const std::string file = folder_.file("clock");
    std::ofstream(file) << std::string(sizeof(double), '\0');
    const int handle = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
    void* shared = ::mmap(nullptr, sizeof(double), PROT_READ | PROT_WRITE, MAP_SHARED, handle, 0);
    ::close(handle);
    if (shared == MAP_FAILED) throw std::runtime_error("no memory is shared with " + file);
    offset_ = static_cast<volatile double*>(shared);
    const char* before = std::getenv("LD_PRELOAD");
    ::setenv("STEPPED_CLOCK", file.c_str(), 1);
    ::setenv("LD_PRELOAD", (std::string(STEPPED_CLOCK) + (before ? std::string(":") + before : "")).c_str(), 1);
  }
  SteppedClock(const SteppedClock&) = delete;
  SteppedClock& operator=(const SteppedClock&) = delete;

  // s, from what the clock said at first.
  void set(double offset) { *offset_ = offset; }

 private:
  test_support::TemporaryFolder folder_;
  volatile double* offset_;
};

}  // namespace laparoscope_servo::test
