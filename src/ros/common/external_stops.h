// Stops of the arm from outside of ROS, for the aesop node and the controller: the ROS master's end, a stop line, the
// signal SIGUSR1. Each is printed on the terminal, which works without a master.
//
// One thread calls; nothing here blocks it.
#pragma once

#include <cstdint>
#include <string>

#include "laparoscope_servo/parameters/table.h"
#include "ros/common/master_watch.h"
#include "ros/common/stop_line.h"

namespace diagnostic_updater {
class DiagnosticStatusWrapper;
}

namespace laparoscope_servo {

struct ExternalStopsConfig {
  MasterWatchConfig master;
  StopLineConfig stop_line;
};

// Adds the rows of the groups `master` and `stop_line`.
void describe(parameters::Table& table, ExternalStopsConfig& config);

class ExternalStops {
 public:
  // Construct it after the first NodeHandle, when the node is registered with the master.
  explicit ExternalStops(const ExternalStopsConfig& config);

  // Reason of a stop since the last call (a signal, the stop line); empty: none. Call at every step of the loop; also
  // prints changes of the master's state on the terminal. `now`: s, steady.
  std::string takeStop(double now);
  // Why the arm may not move now (the stop line, the master); empty: it may.
  std::string obstacle(double now) const;
  // Why the arm may not move because of the master; empty: it may.
  const std::string& masterProblem() const { return master_status_.reason; }
  // Whether the master's answer is late: zero velocity meanwhile; motion resumes without a service call.
  bool masterIsLate(double now) const;
  // Whether the node is no longer registered (another master, or one that has forgotten it): it must be restarted.
  bool mustEnd() const { return master_status_.state == MasterStatus::State::kChanged; }

  void describe(double now, diagnostic_updater::DiagnosticStatusWrapper& status) const;

 private:
  void followMaster();

  double hold_;  // s
  StopLine stop_line_;
  MasterWatch master_;
  MasterStatus master_status_;
  std::uint64_t line_stops_ = 0;  // number of stops of the line that takeStop() has returned
  std::string line_problem_;      // obstacle of the line at the last call
};

}  // namespace laparoscope_servo
