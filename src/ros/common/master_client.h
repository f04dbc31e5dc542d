// Calls of the ROS master's API on a socket of their own, each bounded in time. Those of roscpp repeat for ever when
// the master is away, and share one thread with everything else that the node asks it.
#pragma once

#include <XmlRpcValue.h>
#include <sys/socket.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace laparoscope_servo {

class MasterClient {
 public:
  enum class Outcome {
    kAnswered,
    kRefused,   // nobody listens there, or who listened has closed the connection without an answer
    kSilent,    // no answer in time, or this process could not even ask
    kNonsense,  // an answer, but not that of a ROS master
  };

  // The address is looked up until it is found, and then no more. Until then every call is kSilent.
  MasterClient(const std::string& host, std::uint32_t port);

  // Waits for at most `patience` s; less when `ending` becomes true. `result`: what the master returned, a list of
  // code, message and value.
  Outcome call(const std::string& method, const std::vector<std::string>& arguments, double patience,
               const std::atomic<bool>& ending, XmlRpc::XmlRpcValue& result);
  // A connection on which nothing is asked: it closes when the master's process ends. -1 when there is none. The caller
  // closes it.
  int connect(double patience, const std::atomic<bool>& ending);
  // What was wrong with the last call, in words; empty after an answer.
  const std::string& problem() const { return problem_; }
  const std::string& address() const { return address_; }  // host:port

 private:
  Outcome fail(Outcome outcome, const std::string& problem);
  Outcome open(double deadline, const std::atomic<bool>& ending, int& file);
  Outcome exchange(int file, const std::string& question, double deadline, const std::atomic<bool>& ending,
                   std::string& body);

  void lookUp();

  std::string host_;
  std::uint32_t port_;
  std::string address_;
  std::vector<sockaddr_storage> peers_;
  std::vector<socklen_t> sizes_;
  std::string problem_;
};

}  // namespace laparoscope_servo
