// Calls of the ROS master's API on a separate socket, each bounded in time. roscpp's own calls repeat for ever when the
// master is away, and share one thread with all other calls of the node.
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
    kRefused,   // nothing listens there, or the connection was closed without an answer
    kSilent,    // no answer in time, or this process could not send the request
    kNonsense,  // an answer that is not that of a ROS master
  };

  // The address is looked up until it is found, then kept. Until then every call returns kSilent.
  MasterClient(const std::string& host, std::uint32_t port);

  // Waits for at most `patience` s; less when `ending` becomes true. `result`: what the master returned, a list of
  // code, message and value.
  Outcome call(const std::string& method, const std::vector<std::string>& arguments, double patience,
               const std::atomic<bool>& ending, XmlRpc::XmlRpcValue& result);
  // Opens a connection without a request, which closes when the master's process ends. -1 if there is none. The caller
  // closes it.
  int connect(double patience, const std::atomic<bool>& ending);
  // Error of the last call; empty after an answer.
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
