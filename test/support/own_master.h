// A ROS master of the test's own, that may be killed, stopped and started anew on the same port. For a test that is no
// rostest: there the master is not the test's to kill.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include "system/aesop/child_process.h"

namespace laparoscope_servo::test_support {

class OwnMaster {
 public:
  // Before ros::init: it sets ROS_MASTER_URI.
  OwnMaster() : port_(freePort()) {
    ::setenv("ROS_MASTER_URI", ("http://localhost:" + std::to_string(port_)).c_str(), 1);
    start();
  }

  void start() {
    process_.reset();
    process_ = std::make_unique<test::ChildProcess>(
        "/usr/bin/env", std::vector<std::string>{"rosmaster", "--core", "-p", std::to_string(port_)}, "/dev/null");
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!listens()) {
      if (std::chrono::steady_clock::now() > end) throw std::runtime_error("no ROS master");
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  void kill(int signal) { process_->kill(signal); }
  // Killed, and nobody in its place when this returns.
  void end() {
    kill(SIGKILL);
    process_->exitStatus(10.0);
  }

 private:
  static sockaddr_in address(int port) {
    sockaddr_in name{};
    name.sin_family = AF_INET;
    name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    name.sin_port = htons(static_cast<std::uint16_t>(port));
    return name;
  }
  static int freePort() {
    const int file = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in name = address(0);
    socklen_t size = sizeof(name);
    ::bind(file, reinterpret_cast<const sockaddr*>(&name), size);
    ::getsockname(file, reinterpret_cast<sockaddr*>(&name), &size);
    ::close(file);
    return ntohs(name.sin_port);
  }
  bool listens() const {
    const int file = ::socket(AF_INET, SOCK_STREAM, 0);
    const sockaddr_in name = address(port_);
    const bool connected = ::connect(file, reinterpret_cast<const sockaddr*>(&name), sizeof(name)) == 0;
    ::close(file);
    return connected;
  }

  int port_;
  std::unique_ptr<test::ChildProcess> process_;
};

}  // namespace laparoscope_servo::test_support
