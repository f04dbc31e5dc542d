// Decides whose messages are accepted on a topic: those of the node named by the configuration, on one connection; if
// no node is named, those of the connection that published first.
//
// ROS 1 does not authenticate names (doc/network.md). If two processes use the owner's name, there is a second
// connection, which is not accepted until the arm is at rest and an operator has confirmed it.
#pragma once

#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <limits>
#include <string>

namespace laparoscope_servo {

class InputOwner {
 public:
  // Identifies a connection by any object that exists once for it; kept alive, so that its address is not used again.
  using Connection = boost::shared_ptr<const void>;
  enum class Verdict {
    kOwner,          // counts
    kNewConnection,  // the owner's name, but not its present connection
    kStranger,       // another node
  };

  // `name`: resolved, e.g. "/controller"; empty: any node. `what`: name of the messages for texts, e.g. "commands".
  // `parameter`: the parameter that holds the name.
  InputOwner(const std::string& name, const std::string& what, const std::string& parameter)
      : name_(name), what_(what), parameter_(parameter) {}

  // `sender`: node name of the connection; `now`: s, steady. The first connection of the owner after a release is
  // accepted.
  Verdict judge(const std::string& sender, const Connection& connection, double now);
  // Call while messages cannot move the arm: the accepted connection is then open again.
  void release() { connection_.reset(); }

  // The configured owner.
  const std::string& name() const { return name_; }
  const std::string& what() const { return what_; }
  // Number of messages refused because of their sender, since the start.
  std::uint64_t refused() const { return refused_; }
  // Whose messages are refused, and why; empty if none has come for a while.
  std::string complaint(double now) const;

 private:
  std::string name_;
  std::string what_;
  std::string parameter_;
  Connection connection_;
  std::string bound_;  // node name of the accepted connection
  std::string stranger_;
  double stranger_at_ = -std::numeric_limits<double>::infinity();
  std::uint64_t refused_ = 0;
};

// A node name from the network, made safe for display.
std::string shownName(const std::string& name);

}  // namespace laparoscope_servo
