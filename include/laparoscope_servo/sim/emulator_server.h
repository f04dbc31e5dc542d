// The emulator as a running thing: a pty, a control socket, real time.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "laparoscope_servo/sim/faults.h"

namespace laparoscope_servo::sim {

struct ServerConfig {
  std::string link;                    // the port's name
  std::string control;                 // path of the control socket; none when empty
  std::uint32_t seed = 1;              // of the line's dice
  int baud_rate = 0;                   // bit/s; 0: bytes take no time
  std::vector<ScheduledFault> script;  // s since the start
};

class EmulatorServer {
 public:
  // Throws std::runtime_error and std::invalid_argument, each naming what is wrong.
  EmulatorServer(const EmulatorConfig& config, const ServerConfig& server);
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
