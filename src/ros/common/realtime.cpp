#include "ros/common/realtime.h"

#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <sstream>

namespace laparoscope_servo {

namespace {

std::string takePriority(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  if (::sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters) == 0) return "";
  const int error = errno;
  rlimit limit{};
  ::getrlimit(RLIMIT_RTPRIO, &limit);
  std::ostringstream text;
  text << "real-time priority " << priority << " was refused (" << std::strerror(error)
       << "), the loop runs at the ordinary one: the limit RLIMIT_RTPRIO of this process is " << limit.rlim_cur
       << "; raise it by 'LimitRTPRIO=' in the systemd unit, or by a line '@dialout - rtprio " << priority
       << "' in /etc/security/limits.d and a new login";
  return text.str();
}

// Only without a limit: with one, later allocations would fail.
std::string lockMemory() {
  rlimit limit{};
  ::getrlimit(RLIMIT_MEMLOCK, &limit);
  if (limit.rlim_cur != RLIM_INFINITY && ::geteuid() != 0) {
    return "memory is not locked: the limit RLIMIT_MEMLOCK of this process is " + std::to_string(limit.rlim_cur) +
           " bytes, expected none; set 'LimitMEMLOCK=infinity' in the systemd unit, or '@dialout - memlock unlimited' "
           "in /etc/security/limits.d";
  }
  if (::mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0) return "";
  return std::string("memory is not locked: ") + std::strerror(errno);
}

}  // namespace

std::string goRealtime(int priority) {
  const std::string refused = takePriority(priority);
  const std::string paged = lockMemory();
  return refused + (refused.empty() || paged.empty() ? "" : "; ") + paged;
}

}  // namespace laparoscope_servo
