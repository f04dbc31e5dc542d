// What stops the arm from outside of ROS, for the node that drives it and for the node that controls it: the ROS
// master's end, a stop line, the signal SIGUSR1. Each is said on the terminal, which works without a master.
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

// The groups `master` and `stop_line`.
void describe(parameters::Table& table, ExternalStopsConfig& config);

class ExternalStops {
 public:
  // After the node has registered with the master: once its first NodeHandle was made.
  explicit ExternalStops(const ExternalStopsConfig& config);

  // What asks for a stop since the last call, in words: a signal, the stop line; empty: nothing. To be called at every
  // step of the loop; also says on the terminal what has become of the master. `now`: s, steady.
  std::string takeStop(double now);
  // Why the arm may not move now: the stop line, the master.
  std::string obstacle(double now) const;
  // The same for the master alone.
  const std::string& masterProblem() const { return master_status_.reason; }
  // An answer of the master is due: until it comes the arm is held, but nobody has to let it go again.
  bool masterIsLate(double now) const;
  // Another master, or one that has forgotten this node: it can be found by nobody, and has to be started anew.
  bool mustEnd() const { return master_status_.state == MasterStatus::State::kChanged; }

  void describe(double now, diagnostic_updater::DiagnosticStatusWrapper& status) const;

 private:
  void followMaster();

  double hold_;  // s
  StopLine stop_line_;
  MasterWatch master_;
  MasterStatus master_status_;
  std::uint64_t line_stops_ = 0;  // that were taken
  std::string line_problem_;      // at the last call
};

}  // namespace laparoscope_servo
