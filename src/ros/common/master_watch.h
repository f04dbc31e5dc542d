// Is the ROS master there, is it the one of the start, and does it still know this node? Without it nobody can call a
// service of the node any more, and a new one starts a second node beside it that knows nothing of the first.
//
// A thread of its own asks: whoever controls something only looks at the latest answer. Between two questions it keeps
// a connection open, by which it notices at once that the master's process has ended.
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
  double hold = 0.25;     // s: while an answer takes longer, the arm is held
  double patience = 0.7;  // s, hold to 60: after so long without an answer the master is taken for dead
};

void describe(parameters::Table& table, MasterWatchConfig& config);
std::vector<std::string> validate(const MasterWatchConfig& config);

struct MasterStatus {
  enum class State {
    kKnown,    // it answers, and knows this node; so it is taken to be until the first answer
    kSilent,   // it has not answered in time
    kGone,     // nobody is there
    kChanged,  // it does not know this node, at this address: another master, or another node of this name
  };
  State state = State::kKnown;
  std::string reason;        // of what is not kKnown, in words
  double asked_at = 0.0;     // s, steady: of the question that is not answered yet; 0: there is none
  double answer_time = 0.0;  // s, that the last answer took
  double longest = 0.0;      // s, that any has taken
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
  // Less when the master's process ends or the watch does; false when the watch does.
  bool wait(double seconds);

  MasterWatchConfig config_;
  MasterClient client_;
  std::string node_;
  std::string uri_;
  int pid_ = 0;               // of the master at the start; 0: not known yet
  bool asks_for_us_ = false;  // the next question: whether it knows this node, or who it is
  mutable std::mutex mutex_;
  int lifeline_ = -1;  // the connection that is kept
  std::atomic<bool> ending_{false};
  MasterStatus status_;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace laparoscope_servo
