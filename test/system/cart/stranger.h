// Another process that publishes what the cart's own nodes publish: nobody asked it to.
#pragma once

#include <memory>
#include <string>

#include "system/aesop/aesop_bench.h"

namespace laparoscope_servo::test {

class Stranger {
 public:
  // A node /stranger_... that says `what` on `topic` at `rate` Hz, once begin() is called; see stranger.cpp for the
  // words. It is connected to who listens when the constructor returns. Throws when nobody listens within 10 s.
  Stranger(AesopBench& bench, const std::string& topic, const std::string& what, double rate);

  void begin() { process_->kill(SIGUSR2); }

 private:
  std::unique_ptr<ChildProcess> process_;
};

// main() of that process.
int runStranger(int argc, char** argv);

}  // namespace laparoscope_servo::test
