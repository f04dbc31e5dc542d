#include "ros/common/stop_line.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <future>
#include <limits>
#include <thread>

#include "ros/common/clocks.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

bool mentions(const std::string& text, const std::string& what) {
  return text.find(what) != std::string::npos;
}

template <typename Condition>
bool waitFor(Condition condition, double seconds = 10.0) {
  const double end = steadyNow() + seconds;
  while (!condition()) {
    if (steadyNow() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

class StopLineFile : public ::testing::Test {
 protected:
  StopLineFile() { config_.path = folder_.file("line"); }
  void set(const std::string& text) {
    std::ofstream(folder_.file("new")) << text;
    ASSERT_EQ(::rename(folder_.file("new").c_str(), config_.path.c_str()), 0);
  }
  std::string read() {
    int file = -1;
    return readStopLine(config_, file);
  }
  test_support::TemporaryFolder folder_;
  StopLineConfig config_;
};

TEST_F(StopLineFile, onlyTheReleasedLevelLetsGo) {
  EXPECT_TRUE(mentions(read(), "cannot be read")) << "it is not there";
  struct Case {
    const char* text;
    bool zero, one;  // may the arm move, where that is the level of release
  };
  for (const Case& c :
       {Case{"1", false, true}, Case{"1\n", false, true}, Case{"0\n", true, false}, Case{"", false, false},
        Case{"\n", false, false}, Case{"x1", false, false}, Case{" 1", false, false}, Case{"\xff", false, false}}) {
    set(c.text);
    config_.release = 0;
    EXPECT_EQ(read().empty(), c.zero) << c.text;
    config_.release = 1;
    EXPECT_EQ(read().empty(), c.one) << c.text;
  }
  EXPECT_TRUE(mentions(read(), config_.path)) << read();
}

TEST_F(StopLineFile, whatIsNoFileStops) {
  ASSERT_EQ(::mkdir(config_.path.c_str(), 0700), 0);
  EXPECT_TRUE(mentions(read(), "cannot be read"));
  ::rmdir(config_.path.c_str());
  ASSERT_EQ(::mkfifo(config_.path.c_str(), 0600), 0);
  EXPECT_TRUE(mentions(read(), "cannot be read")) << "nobody writes to it";
  const int writer = ::open(config_.path.c_str(), O_RDWR);
  EXPECT_TRUE(mentions(read(), "cannot be read")) << "nothing is written to it";
  ::close(writer);
}

TEST_F(StopLineFile, aPortWithoutModemLinesStops) {
  const int master = ::posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_GE(master, 0);
  ASSERT_EQ(::grantpt(master), 0);
  ASSERT_EQ(::unlockpt(master), 0);
  config_.path = ::ptsname(master);
  for (const char* signal : {"CTS", "DSR", "CD"}) {
    config_.signal = signal;
    for (config_.release = 0; config_.release < 2; ++config_.release) EXPECT_TRUE(mentions(read(), signal)) << read();
  }
  ::close(master);
  EXPECT_TRUE(mentions(read(), "cannot be read")) << "its device has gone";
}

TEST_F(StopLineFile, theThreadFollowsTheFile) {
  set("1");
  const StopLine line(config_);
  EXPECT_TRUE(line.isThere());
  ASSERT_TRUE(waitFor([&] { return line.obstacle(steadyNow()).empty(); }));
  EXPECT_EQ(line.stops(), 0u);
  set("0");
  ASSERT_TRUE(waitFor([&] { return mentions(line.obstacle(steadyNow()), "says stop"); }));
  EXPECT_EQ(line.stops(), 1u);
  set("1");
  ASSERT_TRUE(waitFor([&] { return line.obstacle(steadyNow()).empty(); }));
  ::unlink(config_.path.c_str());
  ASSERT_TRUE(waitFor([&] { return mentions(line.obstacle(steadyNow()), "cannot be read"); }));
  EXPECT_EQ(line.stops(), 2u);
  EXPECT_TRUE(mentions(line.lastStop(), "cannot be read"));
}

TEST(StopLine, noneStopsNothing) {
  const StopLine line{StopLineConfig()};
  EXPECT_FALSE(line.isThere());
  EXPECT_EQ(line.obstacle(steadyNow()), "");
  EXPECT_EQ(line.stops(), 0u);
}

TEST(StopLine, aPulseOfOneReadingIsNotLost) {
  std::atomic<int> readings{0};
  const auto read = [&] { return ++readings == 5 ? std::string("a pulse") : std::string(); };
  {
    StopLineConfig config;
    config.rate = 1000.0;
    const StopLine line(config, read);
    ASSERT_TRUE(waitFor([&] { return line.stops() == 1; }));
    EXPECT_TRUE(waitFor([&] { return line.obstacle(steadyNow()).empty(); }));
    EXPECT_EQ(line.lastStop(), "a pulse");
  }
  // The thread may be in its last reading.
  const int before = readings;
  EXPECT_TRUE(waitFor([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return readings <= before + 1;
  }));
}

// Neither who asks nor who ends the line waits for a reading that never returns.
TEST(StopLine, aReadingThatBlocksStops) {
  auto release = std::make_shared<std::promise<void>>();
  const std::shared_future<void> blocked = release->get_future().share();
  const auto readings = std::make_shared<std::atomic<int>>(0);
  {
    StopLineConfig config;
    config.patience = 0.2;
    const StopLine line(config, [readings, blocked] {
      if (++*readings > 3) blocked.wait();
      return std::string();
    });
    ASSERT_TRUE(waitFor([&] { return *readings > 3; }));
    EXPECT_TRUE(waitFor([&] { return mentions(line.obstacle(steadyNow()), "no reading for 0.2 s"); }));
  }
  release->set_value();
}

TEST(StopLine, beforeTheFirstReadingTheArmMayNotMove) {
  auto release = std::make_shared<std::promise<void>>();
  const std::shared_future<void> blocked = release->get_future().share();
  const StopLine line(StopLineConfig(), [blocked] {
    blocked.wait();
    return std::string();
  });
  EXPECT_TRUE(mentions(line.obstacle(steadyNow()), "not been read yet"));
  EXPECT_EQ(line.stops(), 0u);
  release->set_value();
  EXPECT_TRUE(waitFor([&] { return line.obstacle(steadyNow()).empty(); }));
}

TEST(StopLineConfig, errorsAreNamed) {
  EXPECT_TRUE(validate(StopLineConfig()).empty());
  StopLineConfig config;
  config.signal = "RTS";
  config.release = 2;
  config.rate = config.patience = std::numeric_limits<double>::quiet_NaN();
  ASSERT_EQ(validate(config).size(), 4u);
  EXPECT_TRUE(mentions(validate(config)[0], "RTS"));
}

}  // namespace
}  // namespace laparoscope_servo
