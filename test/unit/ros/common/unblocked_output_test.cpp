// Each test is a child process that prints, and a parent that reads what it prints, late, or not at all.
#include "ros/common/unblocked_output.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <functional>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>

namespace laparoscope_servo {
namespace {

// Runs `body` with `target` in place of what it prints to; it speaks to the test by `report` and `order`.
class Child {
 public:
  Child(int target, const std::function<void(Child&)>& body) {
    EXPECT_EQ(::pipe2(report_, O_CLOEXEC), 0);
    EXPECT_EQ(::pipe2(order_, O_CLOEXEC), 0);
    std::fflush(nullptr);  // what waits there would come out of the child, too
    pid_ = ::fork();
    if (pid_ != 0) {
      ::close(report_[1]);
      report_[1] = -1;
      return;
    }
    forgetBuffering();
    ::dup2(target, STDOUT_FILENO);
    ::dup2(target, STDERR_FILENO);
    body(*this);
    std::exit(0);
  }
  ~Child() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    for (const int file : {report_[0], report_[1], order_[0], order_[1]}) ::close(file);
  }

  // As in a process that has not printed yet: glibc keeps to what a stream was until it is flushed with something in
  // it.
  static void forgetBuffering() {
    ::dup2(::open("/dev/null", O_WRONLY | O_CLOEXEC), STDOUT_FILENO);
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
    std::fputs("\n", stdout);
    std::fflush(stdout);
  }
  // For the child.
  void tell() { EXPECT_EQ(::write(report_[1], "x", 1), 1); }
  void waitForOrder() {
    char c;
    EXPECT_EQ(::read(order_[0], &c, 1), 1);
  }
  // For the test: false when the child does not come so far.
  bool hasTold(double seconds = 40.0) {
    pollfd entry{report_[0], POLLIN, 0};
    char c;
    return ::poll(&entry, 1, static_cast<int>(1000.0 * seconds)) == 1 && ::read(report_[0], &c, 1) == 1;
  }
  void order() { EXPECT_EQ(::write(order_[1], "x", 1), 1); }
  // The status of waitpid.
  int end() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return status;
  }

 private:
  pid_t pid_ = -1;
  int report_[2];
  int order_[2];
};

struct Pipe {
  Pipe() { EXPECT_EQ(::pipe2(ends, O_CLOEXEC), 0); }
  ~Pipe() {
    for (const int end : ends) ::close(end);
  }
  void closeWriter() {
    ::close(ends[1]);
    ends[1] = -1;
  }
  // Until nobody has the other end any more.
  std::string readAll() {
    closeWriter();
    std::string text;
    char buffer[65536];
    ssize_t count = 0;
    while ((count = ::read(ends[0], buffer, sizeof(buffer))) > 0) text.append(buffer, static_cast<std::size_t>(count));
    return text;
  }
  int ends[2];
};

TEST(UnblockedOutput, everythingComesInOrder) {
  Pipe pipe;
  constexpr int kLines = 2000;
  Child child(pipe.ends[1], [](Child&) {
    const UnblockedOutput output;
    for (int k = 0; k < kLines; ++k) std::fprintf(k % 3 == 0 ? stderr : stdout, "line %d\n", k);
    std::cout << "the last line" << std::endl;
  });
  std::istringstream text(pipe.readAll());
  EXPECT_EQ(child.end(), 0);
  std::string line;
  for (int k = 0; k < kLines; ++k) {
    std::getline(text, line);
    ASSERT_EQ(line, "line " + std::to_string(k));
  }
  std::getline(text, line);
  EXPECT_EQ(line, "the last line");
  EXPECT_FALSE(std::getline(text, line));
}

TEST(UnblockedOutput, twoTargetsStayApart) {
  Pipe out;
  Pipe err;
  Child child(out.ends[1], [&](Child&) {
    ::dup2(err.ends[1], STDERR_FILENO);
    const UnblockedOutput output;
    std::printf("to stdout\n");
    std::fputs("to stderr\n", stderr);
  });
  EXPECT_EQ(out.readAll(), "to stdout\n");
  EXPECT_EQ(err.readAll(), "to stderr\n");
  EXPECT_EQ(child.end(), 0);
}

// 5 lines of 200 bytes in a millisecond, far more than anything holds that lies in between.
constexpr int kFlood = 12000;

void flood(Child& child) {
  const UnblockedOutput output;
  const std::string rest(190, '.');
  for (int k = 0; k < kFlood; ++k) {
    std::printf("%6d %s\n", k, rest.c_str());
    if (k % 5 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  child.tell();
  child.waitForOrder();
}

TEST(UnblockedOutput, aPipeThatNobodyReadsHoldsNobodyUp) {
  Pipe pipe;
  Child child(pipe.ends[1], flood);
  ASSERT_TRUE(child.hasTold()) << "it waits for a reader";
  child.order();
  std::istringstream text(pipe.readAll());
  EXPECT_EQ(child.end(), 0);
  int lines = 0;
  int dropped = 0;
  std::string line;
  while (std::getline(text, line)) {
    int count = 0;
    if (std::sscanf(line.c_str(), "[%d lines of this log were dropped", &count) == 1) {
      dropped += count;
    } else {
      EXPECT_EQ(line.size(), 197u) << "a torn line: " << line;
      ++lines;
    }
  }
  EXPECT_GT(dropped, 0);
  EXPECT_GT(lines, 4000) << "a megabyte is kept";
  EXPECT_EQ(lines + dropped, kFlood);
}

TEST(UnblockedOutput, aTerminalThatStandsHoldsNobodyUp) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_GE(terminal, 0);
  ASSERT_EQ(::grantpt(terminal), 0);
  ASSERT_EQ(::unlockpt(terminal), 0);
  const int target = ::open(::ptsname(terminal), O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_GE(target, 0);
  ASSERT_EQ(::write(terminal, "\x13", 1), 1);  // Ctrl-S
  {
    Child child(target, flood);
    EXPECT_TRUE(child.hasTold()) << "it waits for Ctrl-Q";
    child.order();
    EXPECT_EQ(child.end(), 0) << "it ends, without its last words";
  }
  ::close(target);
  ::close(terminal);
}

TEST(UnblockedOutput, aReaderThatHasGoneEndsNobody) {
  Pipe pipe;
  Child child(pipe.ends[1], [&](Child& self) {
    ::close(pipe.ends[0]);
    pipe.closeWriter();
    self.waitForOrder();
    flood(self);
  });
  pipe.closeWriter();
  ::close(pipe.ends[0]);
  pipe.ends[0] = -1;
  child.order();
  ASSERT_TRUE(child.hasTold());
  child.order();
  EXPECT_EQ(child.end(), 0);
}

TEST(UnblockedOutput, aFullDiskHoldsNobodyUpAndIsCounted) {
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  ASSERT_GE(full, 0);
  Child child(full, [](Child& self) {
    const UnblockedOutput output;
    std::printf("this is lost\n");
    while (droppedLogLines() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    self.tell();
  });
  EXPECT_TRUE(child.hasTold());
  EXPECT_EQ(child.end(), 0);
  ::close(full);
}

TEST(UnblockedOutput, lastWordsAreKept) {
  struct Case {
    const char* name;
    std::function<void()> end;
    int signal;  // by which it ends, or 0
    const char* says;
  };
  const Case cases[] = {
      {"exit", [] { std::exit(0); }, 0, "before the end\nand no newline"},
      {"abort", [] { std::abort(); }, SIGABRT, "before the end\n"},
      {"exception", [] { throw std::runtime_error("why it ends"); }, SIGABRT, "why it ends"},
      {"segmentation fault", [] { ::raise(SIGSEGV); }, SIGSEGV, "before the end\n"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    Pipe pipe;
    Child child(pipe.ends[1], [&](Child&) {
      [&]() noexcept {  // what the test framework catches does not end a process
        const UnblockedOutput output;
        std::printf("before the end\n");
        std::fputs("and no newline", stdout);
        c.end();
      }();
    });
    const std::string text = pipe.readAll();
    const int status = child.end();
    EXPECT_NE(text.find("before the end\n"), std::string::npos) << text;
    EXPECT_NE(text.find(c.says), std::string::npos) << text;
    if (c.signal == 0) {
      EXPECT_TRUE(WIFEXITED(status));
    } else {
      EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == c.signal) << status;
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo
