#include "ros/common/master_watch.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "ros/common/clocks.h"
#include "ros/common/quiet_thread.h"

namespace laparoscope_servo {

namespace {

using State = MasterStatus::State;
using Outcome = MasterClient::Outcome;

// s, since a listener with a full queue also refuses for a moment
constexpr double kSecondTry = 0.1;
constexpr double kSlice = 0.05;  // s, period for checking the end of the watch
constexpr double kLate = 0.1;    // s, two slices: a running thread is not late by more

int integer(XmlRpc::XmlRpcValue& value) {
  return value.getType() == XmlRpc::XmlRpcValue::TypeInt ? static_cast<int>(value) : 0;
}

std::string text(XmlRpc::XmlRpcValue& value) {
  return value.getType() == XmlRpc::XmlRpcValue::TypeString ? static_cast<std::string>(value) : std::string();
}

}  // namespace

void describe(parameters::Table& table, MasterWatchConfig& c) {
  table.number("period", c.period, {0.05, 5}, "s", "between two requests to it");
  table.number("hold", c.hold, {0.05, 5}, "s", "if an answer takes longer, the arm stops until it comes");
  table
      .number("patience", c.patience, {0.05, 60}, "s",
              "time without an answer after which it counts as silent, and motion does not resume by itself")
      .atLeast("hold");
}

std::vector<std::string> validate(const MasterWatchConfig& config) {
  return parameters::errorsOf(config);
}

const char* name(State state) {
  switch (state) {
    case State::kKnown:
      return "answers";
    case State::kSilent:
      return "does not answer";
    case State::kGone:
      return "is gone";
    case State::kChanged:
      return "is another one";
  }
  return "unknown";
}

MasterWatch::MasterWatch(const MasterWatchConfig& config, const std::string& host, std::uint32_t port,
                         const std::string& node, const std::string& uri)
    : config_(config), client_(host, port), node_(node), uri_(uri), thread_(startQuietThread([this] { run(); })) {}

MasterWatch::~MasterWatch() {
  ending_ = true;
  thread_.join();
  if (lifeline_ >= 0) ::close(lifeline_);
}

MasterStatus MasterWatch::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_;
}

bool MasterWatch::wait(double seconds) {
  const double end = steadyNow() + seconds;
  while (!ending_) {
    const double left = std::max(0.0, end - steadyNow());
    pollfd entry{lifeline_, POLLIN, 0};  // with a negative descriptor poll() only waits
    if (::poll(&entry, 1, static_cast<int>(1000.0 * std::min(left, kSlice))) > 0) {
      ::close(std::exchange(lifeline_, -1));
      return true;
    }
    if (left == 0.0) return true;
  }
  return false;
}

void MasterWatch::run() {
  do {
    MasterStatus status = ask();
    if (ending_) return;
    if (status.state == State::kKnown && lifeline_ < 0) lifeline_ = client_.connect(config_.patience, ending_);
    const std::lock_guard<std::mutex> lock(mutex_);
    status.longest = std::max(status_.longest, status.answer_time);
    if (status.state != State::kKnown) status.answer_time = status_.answer_time;
    status_ = status;
  } while (wait(config_.period));
}

MasterStatus MasterWatch::ask() {
  const double start = steadyNow();
  MasterStatus status = judge();
  // This thread itself was late, as after a pause of the process, so the master was not silent.
  if (status.state == State::kSilent && steadyNow() - start > config_.patience + kLate) status = judge();
  if (status.state == State::kGone) asks_for_us_ = false;  // the next question is which master is there
  if (status.state == State::kGone && wait(kSecondTry)) status = judge();
  return status;
}

MasterStatus MasterWatch::judge() {
  const double start = steadyNow();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (status_.asked_at == 0.0) status_.asked_at = start;
  }
  const std::string method = asks_for_us_ ? "lookupNode" : "getPid";
  std::vector<std::string> arguments{node_};
  if (asks_for_us_) arguments.push_back(node_);
  const std::string master = "the ROS master at " + client_.address();
  MasterStatus status;
  XmlRpc::XmlRpcValue answer;
  switch (client_.call(method, arguments, config_.patience, ending_, answer)) {
    case Outcome::kAnswered:
      status = asks_for_us_ ? judgeNode(answer, master) : judgeProcess(answer, master);
      status.answer_time = steadyNow() - start;
      asks_for_us_ = !asks_for_us_;
      return status;
    case Outcome::kSilent: {
      std::ostringstream words;
      words << master << " has not answered for " << config_.patience << " s (" << client_.problem() << ")";
      status.state = State::kSilent;
      status.reason = words.str();
      return status;
    }
    case Outcome::kRefused:
    case Outcome::kNonsense:
      break;
  }
  status.state = State::kGone;
  status.reason = master + " is gone (" + client_.problem() + ")";
  return status;
}

MasterStatus MasterWatch::judgeProcess(XmlRpc::XmlRpcValue& answer, const std::string& master) {
  const int pid = integer(answer[2]);
  if (pid_ == 0) pid_ = pid;
  MasterStatus status;
  if (pid == pid_) return status;
  status.state = State::kChanged;
  status.reason = master + " is another one (process " + std::to_string(pid) + ", at the start it was " +
                  std::to_string(pid_) + ")";
  return status;
}

MasterStatus MasterWatch::judgeNode(XmlRpc::XmlRpcValue& answer, const std::string& master) const {
  MasterStatus status;
  if (integer(answer[0]) != 1) {
    status.state = State::kChanged;
    status.reason = master + " does not know this node any more";
  } else if (text(answer[2]) != uri_) {
    status.state = State::kChanged;
    status.reason = master + " knows another node as " + node_ + ", at " + text(answer[2]);
  }
  return status;
}

}  // namespace laparoscope_servo
