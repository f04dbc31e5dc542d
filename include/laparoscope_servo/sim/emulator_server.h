// Runs the emulator in real time, with a pty and a control socket.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "laparoscope_servo/sim/faults.h"

namespace laparoscope_servo::sim {

struct ServerConfig {
  std::string link;                    // the port's name
  std::string control;                 // path of the control socket; empty: none
  std::uint32_t seed = 1;              // seed of the line's random numbers
  int baud_rate = 0;                   // bit/s; 0: no delay
  std::vector<ScheduledFault> script;  // with times in s since the start
};

class EmulatorServer {
 public:
  // Throws std::runtime_error and std::invalid_argument with the error.
  EmulatorServer(const EmulatorConfig& config, const ServerConfig& server);
  ~EmulatorServer();

  // Runs until `stop` becomes true. Throws std::runtime_error if the port cannot be created again after a hangup.
  void run(const std::atomic<bool>& stop);
  // The pseudo-terminal to which the link points at the start.
  const std::string& device() const;

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
};

}  // namespace laparoscope_servo::sim
