// Decides whose velocity commands count: those of the one node that the configuration names, and of it those of one
// connection.
//
// ROS 1 proves nobody's name (doc/network.md). What shows when two processes use the master's is a second connection,
// which is not trusted before the arm has stood still and somebody has said that it may go on.
#pragma once

#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <limits>
#include <string>

namespace laparoscope_servo::skin {

class CommandMaster {
 public:
  // Anything of which there is one object per connection; kept, so that its address is not used again.
  using Connection = boost::shared_ptr<const void>;
  enum class Verdict {
    kMaster,         // counts
    kNewConnection,  // the master's name, but not the connection that has commanded until now
    kStranger,       // another name
  };

  // `name`: resolved, e.g. "/controller".
  explicit CommandMaster(const std::string& name) : name_(name) {}

  // `sender`: the name that came with the connection; `now`: s, steady. The first connection of the master after a
  // release is the one that counts.
  Verdict judge(const std::string& sender, const Connection& connection, double now);
  // To be called while the arm is not enabled: who commands then binds nothing.
  void release() { connection_.reset(); }

  const std::string& name() const { return name_; }
  // Commands refused for their sender, since the start.
  std::uint64_t refused() const { return refused_; }
  // Whose commands are refused, and why; empty when none has come for a while.
  std::string complaint(double now) const;

 private:
  std::string name_;
  Connection connection_;
  std::string stranger_;
  double stranger_at_ = -std::numeric_limits<double>::infinity();
  std::uint64_t refused_ = 0;
};

// A node's name as it came over the network, fit to be shown.
std::string shownName(const std::string& name);

}  // namespace laparoscope_servo::skin
