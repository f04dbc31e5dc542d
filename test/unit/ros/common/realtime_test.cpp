#include "ros/common/realtime.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <thread>

namespace laparoscope_servo {
namespace {

// Priorities and limits stay in the process that takes them.
int exitStatusOf(const std::function<bool()>& succeeds) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(succeeds() ? 0 : 1);
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

bool mentions(const std::string& text, const std::string& what) {
  return text.find(what) != std::string::npos;
}

TEST(Realtime, whereItIsNotPermittedItSaysWhatToDo) {
  EXPECT_EQ(exitStatusOf([] {
              const rlimit none{0, 0};
              ::setrlimit(RLIMIT_RTPRIO, &none);
              ::setrlimit(RLIMIT_MEMLOCK, &none);
              if (::geteuid() == 0 && ::setuid(65534) != 0) return false;
              const std::string text = goRealtime(10);
              return mentions(text, "RLIMIT_RTPRIO of this process is 0") && mentions(text, "LimitRTPRIO") &&
                     mentions(text, "RLIMIT_MEMLOCK") && ::sched_getscheduler(0) == SCHED_OTHER;
            }),
            0);
}

TEST(Realtime, whereItIsPermittedOnlyThisThreadHasIt) {
  EXPECT_EQ(exitStatusOf([] {
              const std::string text = goRealtime(10);
              if (!text.empty()) return ::sched_getscheduler(0) == SCHED_OTHER || mentions(text, "memory");
              bool other = false;
              std::thread([&] { other = ::sched_getscheduler(0) == SCHED_OTHER; }).join();
              return (::sched_getscheduler(0) & ~SCHED_RESET_ON_FORK) == SCHED_FIFO && other;
            }),
            0);
}

TEST(Realtime, aPriorityThatDoesNotExist) {
  EXPECT_EQ(exitStatusOf([] { return mentions(goRealtime(1000), "real-time priority 1000 was refused"); }), 0);
}

}  // namespace
}  // namespace laparoscope_servo
