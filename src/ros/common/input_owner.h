// Decides whose messages count on a topic: those of the one node that the configuration names, and of it those of one
// connection. Where it names none, those of the connection that spoke first.
//
// ROS 1 proves nobody's name (doc/network.md). What shows when two processes use the owner's is a second connection,
// which is not trusted before the arm has stood still and somebody has said that it may go on.
#pragma once

#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <limits>
#include <string>

namespace laparoscope_servo {

class InputOwner {
 public:
  // Anything of which there is one object per connection; kept, so that its address is not used again.
  using Connection = boost::shared_ptr<const void>;
  enum class Verdict {
    kOwner,          // counts
    kNewConnection,  // the owner's name, but not the connection that has spoken until now
    kStranger,       // another name
  };

  // `name`: resolved, e.g. "/controller"; empty: anybody's. `what`: the messages in words, e.g. "commands".
  // `parameter`: where the name is from.
  InputOwner(const std::string& name, const std::string& what, const std::string& parameter)
      : name_(name), what_(what), parameter_(parameter) {}

  // `sender`: the name that came with the connection; `now`: s, steady. The first connection of the owner after a
  // release is the one that counts.
  Verdict judge(const std::string& sender, const Connection& connection, double now);
  // To be called while nothing that comes can move the arm: who speaks then binds nothing.
  void release() { connection_.reset(); }

  // As configured.
  const std::string& name() const { return name_; }
  const std::string& what() const { return what_; }
  // Messages refused for their sender, since the start.
  std::uint64_t refused() const { return refused_; }
  // Whose messages are refused, and why; empty when none has come for a while.
  std::string complaint(double now) const;

 private:
  std::string name_;
  std::string what_;
  std::string parameter_;
  Connection connection_;
  std::string bound_;  // the name that came with the connection
  std::string stranger_;
  double stranger_at_ = -std::numeric_limits<double>::infinity();
  std::uint64_t refused_ = 0;
};

// A node's name as it came over the network, fit to be shown.
std::string shownName(const std::string& name);

}  // namespace laparoscope_servo
