// The emulator as a running thing: a pty, a control socket, real time.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "laparoscope_servo/sim/emulator.h"

namespace laparoscope_servo::sim {

class EmulatorServer {
 public:
  // `link`: the port's name; `control`: path of the control socket, none when empty. Throws std::runtime_error and
  // std::invalid_argument, each naming what is wrong.
  EmulatorServer(const EmulatorConfig& config, const std::string& link, const std::string& control, std::uint32_t seed);
  ~EmulatorServer();

  // Runs until `stop` becomes true. Throws std::runtime_error when the port cannot be made again after a hangup.
  void run(const std::atomic<bool>& stop);
  // The pseudo-terminal behind the link at the start.
  const std::string& device() const;

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
};

}  // namespace laparoscope_servo::sim
