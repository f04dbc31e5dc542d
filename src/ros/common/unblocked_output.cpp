#include "ros/common/unblocked_output.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "ros/common/output_channel.h"

namespace laparoscope_servo {

namespace {

// bytes, the kernel's limit for unprivileged users: a buffer while the threads do not run
constexpr int kPipe = 1 << 20;
constexpr double kFlush = 1.0;     // s, for the last lines at a normal end
constexpr double kLastGasp = 0.3;  // s, in a crash

std::array<OutputChannel*, 2> channels{};  // never deleted: their threads run until the process is no more

// Callable from a signal handler.
void drain(double seconds) {
  const timespec pause{0, 1000000};
  for (int k = 0; k < static_cast<int>(1000.0 * seconds); ++k) {
    bool empty = true;
    for (const OutputChannel* channel : channels) empty = empty && (channel == nullptr || channel->isEmpty());
    if (empty) return;
    ::nanosleep(&pause, nullptr);
  }
}

void onCrash(int signal) {
  drain(kLastGasp);
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

bool sameFile(int a, int b) {
  struct stat first {};
  struct stat second {};
  return ::fstat(a, &first) == 0 && ::fstat(b, &second) == 0 && first.st_dev == second.st_dev &&
         first.st_ino == second.st_ino;
}

// Replaces the descriptors `from`, which all have the target of the first one, by a pipe. Returns false on failure.
bool divert(OutputChannel*& channel, std::initializer_list<int> from) {
  const int target = ::fcntl(*from.begin(), F_DUPFD_CLOEXEC, 3);
  if (target < 0) return false;
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    ::close(target);
    return false;
  }
  ::fcntl(ends[1], F_SETPIPE_SZ, kPipe);
  ::fcntl(ends[1], F_SETFL, O_WRONLY | O_NONBLOCK);
  channel = new OutputChannel(ends[0], target);
  for (const int file : from) ::dup2(ends[1], file);
  ::close(ends[1]);
  return true;
}

}  // namespace

UnblockedOutput::UnblockedOutput() {
  std::fflush(nullptr);
  const bool done = sameFile(STDOUT_FILENO, STDERR_FILENO)
                        ? divert(channels[0], {STDOUT_FILENO, STDERR_FILENO})
                        : divert(channels[0], {STDOUT_FILENO}) && divert(channels[1], {STDERR_FILENO});
  if (!done) std::fprintf(stderr, "what is printed may block: no pipe for it (%s)\n", std::strerror(errno));
  // By default output to a pipe is buffered in blocks of 4 KiB and would appear late.
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
  std::atexit(flushOutput);
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) ::signal(signal, onCrash);
}

UnblockedOutput::~UnblockedOutput() {
  flushOutput();
}

void flushOutput() {
  std::fflush(stdout);
  drain(kFlush);
}

std::uint64_t droppedLogLines() {
  std::uint64_t count = 0;
  for (const OutputChannel* channel : channels) count += channel == nullptr ? 0 : channel->dropped();
  return count;
}

}  // namespace laparoscope_servo
