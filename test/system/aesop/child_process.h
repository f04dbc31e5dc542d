// A process that a test starts, may kill, and never leaves behind: it ends with the thread that has started it, also
// when the test crashes.
#pragma once

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace laparoscope_servo::test {

class ChildProcess {
 public:
  // `output`: a file for what it prints; the test's own output when empty.
  ChildProcess(const std::string& program, const std::vector<std::string>& arguments, const std::string& output = "")
      : pid_(::fork()) {
    if (pid_ < 0) throw std::runtime_error("cannot fork");
    if (pid_ > 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (!output.empty()) {
      const int file = ::open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      ::dup2(file, STDOUT_FILENO);
      ::dup2(file, STDERR_FILENO);
    }
    inheritNothing();
    std::vector<char*> argv{const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    ::execv(program.c_str(), argv.data());
    ::_exit(127);
  }
  ~ChildProcess() {
    if (isRunning()) {
      kill(SIGCONT);
      kill(SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  void kill(int signal) { ::kill(pid_, signal); }

  bool isRunning() {
    if (!ended_ && ::waitpid(pid_, &status_, WNOHANG) == pid_) ended_ = true;
    return !ended_;
  }

  // Waits for the end; -1 when it did not end in time or was killed.
  int exitStatus(double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (isRunning() && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return ended_ && WIFEXITED(status_) ? WEXITSTATUS(status_) : -1;
  }

 private:
  // Sockets of the test would stay open in the child: it would listen where the test listens, and whoever the test
  // closes a connection to would not hear of it.
  static void inheritNothing() {
    DIR* folder = ::opendir("/proc/self/fd");
    if (folder == nullptr) ::_exit(127);
    while (const dirent* entry = ::readdir(folder)) {
      const int file = std::atoi(entry->d_name);
      if (file > STDERR_FILENO) ::fcntl(file, F_SETFD, FD_CLOEXEC);
    }
    ::closedir(folder);
  }

  pid_t pid_;
  bool ended_ = false;
  int status_ = 0;
};

}  // namespace laparoscope_servo::test
