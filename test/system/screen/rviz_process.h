// A real rviz with a configuration of the test's, drawn by the processor.
#pragma once

#include <csignal>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "node/sim/node_bench.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo::test_support {

class RvizProcess {
 public:
  explicit RvizProcess(const std::string& configuration) {
    std::ofstream(folder_.file("test.rviz")) << configuration;
    start();
  }

  // Until the condition holds, which says that rviz is up. Mesa may end rviz at its start: then once more.
  bool comesUp(const std::function<bool()>& is_up) {
    for (int tries = 0; tries < 2; ++tries) {
      if (waitFor([&] { return is_up() || !process_->isRunning(); }) && process_->isRunning()) return true;
      if (process_->isRunning()) return false;
      std::cout << "rviz ended at its start, and is started once more:\n" << log();
      start();
    }
    return false;
  }
  static bool waitFor(const std::function<bool()>& condition) { return test::spinUntil(condition, kPatience); }
  // Whether it ends in order.
  bool ends() {
    process_->kill(SIGINT);
    return waitFor([this] { return !process_->isRunning(); }) && process_->exitStatus(1.0) == 0;
  }
  std::string log() const { return test::contents(folder_.file("log")); }

 private:
  static constexpr double kPatience = 90.0;  // s: rviz starts for half a minute on a busy machine

  void start() {
    process_ = std::make_unique<test::ChildProcess>(
        "/bin/sh", std::vector<std::string>{"-c", "LIBGL_ALWAYS_SOFTWARE=1 exec rviz -d " + folder_.file("test.rviz")},
        folder_.file("log"));
  }

  TemporaryFolder folder_;
  std::unique_ptr<test::ChildProcess> process_;
};

}  // namespace laparoscope_servo::test_support
