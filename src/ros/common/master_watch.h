// Watches whether the ROS master is there, is the one of the start, and still knows this node. Without a master no
// service of the node can be called any more; with a new master a second node may be started beside this one.
//
// A separate thread asks the master; status() only returns the last answer. Between questions it keeps a connection
// open, which closes at once when the master's process ends.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "laparoscope_servo/parameters/table.h"
#include "ros/common/master_client.h"

namespace laparoscope_servo {

// Defaults are those of config/aesop.yaml and config/controller.yaml, group `master`.
struct MasterWatchConfig {
  double period = 0.1;    // s: between two questions
  double hold = 0.25;     // s: while an answer takes longer, the arm stops
  double patience = 0.7;  // s, hold to 60: after this time without an answer the master counts as silent
};

void describe(parameters::Table& table, MasterWatchConfig& config);
std::vector<std::string> validate(const MasterWatchConfig& config);

struct MasterStatus {
  enum class State {
    kKnown,    // it answers and knows this node; also assumed until the first answer
    kSilent,   // it has not answered in time
    kGone,     // no master
    kChanged,  // it does not know this node at this address: another master, or another node of this name
  };
  State state = State::kKnown;
  std::string reason;        // reason for a state other than kKnown
  double asked_at = 0.0;     // s, steady: time of the open question; 0: there is none
  double answer_time = 0.0;  // s, time until the last answer
  double longest = 0.0;      // s, longest time until an answer
};

const char* name(MasterStatus::State state);

class MasterWatch {
 public:
  // `node`, `uri`: the node's resolved name, and where it listens for XML-RPC.
  MasterWatch(const MasterWatchConfig& config, const std::string& host, std::uint32_t port, const std::string& node,
              const std::string& uri);
  ~MasterWatch();
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;

  MasterStatus status() const;

 private:
  void run();
  MasterStatus ask();
  MasterStatus judge();
  MasterStatus judgeProcess(XmlRpc::XmlRpcValue& answer, const std::string& master);
  MasterStatus judgeNode(XmlRpc::XmlRpcValue& answer, const std::string& master) const;
  // Waits for `seconds`, or until the master's process or the watch ends; false if the watch ends.
  bool wait(double seconds);

  MasterWatchConfig config_;
  MasterClient client_;
  std::string node_;
  std::string uri_;
  int pid_ = 0;               // process id of the master at the start; 0: not known yet
  bool asks_for_us_ = false;  // the next question: true: whether it knows this node; false: its process id
  mutable std::mutex mutex_;
  int lifeline_ = -1;  // the connection that is kept open
  std::atomic<bool> ending_{false};
  MasterStatus status_;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace laparoscope_servo
