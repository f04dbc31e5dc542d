// The recording on a disk: kept, rotated, and never in the way.
#include "laparoscope_servo/aesop/wire_log_file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <thread>

#include "support/temporary_folder.h"
#include "unit/aesop/recorded_session.h"

namespace laparoscope_servo::aesop {
namespace {

class WireLogFileTest : public ::testing::Test {
 protected:
  std::vector<WireRecord> read(const std::string& name) {
    std::ifstream file(folder_.file(name), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    return decoded(Bytes(bytes.begin(), bytes.end()));
  }
  bool has(const std::string& name) { return std::filesystem::exists(folder_.file(name)); }
  static bool waitFor(const std::function<bool()>& done) {
    for (int k = 0; k < 1000 && !done(); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return done();
  }
  WireRecord turn(std::size_t size = 20) { return {WireEvent::kSent, time_ += 5000000, Bytes(size, 1)}; }

  test_support::TemporaryFolder folder_;
  WireLogConfig config_{folder_.file("log"), 20, 5};
  std::int64_t time_ = 1000000000;
};

TEST_F(WireLogFileTest, keepsEveryRecord) {
  const RecordedSession session;
  {
    WireLogFile file(config_, "own");
    for (const WireRecord& record : session.tap.records) file.take(record);
    EXPECT_EQ(file.problem(), "");
  }
  EXPECT_EQ(encoded(read("log"), {}), encoded(session.tap.records, {}));
  EXPECT_FALSE(has("log.1"));
}

TEST_F(WireLogFileTest, whatWasTakenIsOnTheDiskSoon) {
  WireLogFile file(config_, "own");
  file.take(turn());
  EXPECT_TRUE(waitFor([&] { return has("log") && read("log").size() == 1; }));
  file.take(turn());
  EXPECT_TRUE(waitFor([&] { return read("log").size() == 2; }));
}

TEST_F(WireLogFileTest, aRecordingDoesNotOverwriteTheOneBefore) {
  for (std::size_t k = 1; k <= 7; ++k) {
    WireLogFile file(config_, "own");
    for (std::size_t m = 0; m < k; ++m) file.take(turn());
  }
  EXPECT_EQ(read("log").size(), 7u);
  for (std::size_t k = 1; k < 5; ++k) EXPECT_EQ(read("log." + std::to_string(k)).size(), 7 - k);
  EXPECT_FALSE(has("log.5"));
}

TEST_F(WireLogFileTest, isBoundedAndKeepsTheLatest) {
  config_.size = 0.1;
  config_.files = 3;
  std::int64_t last = 0;
  {
    WireLogFile file(config_, "own");
    file.take({WireEvent::kState, time_, payloadOf(OperatingState{OperatingMode::kEnabled, true, false, ""})});
    for (int k = 0; k < 20; ++k) {
      for (int m = 0; m < 1000; ++m) file.take(turn());
      last = time_;
      std::this_thread::sleep_for(std::chrono::milliseconds(k % 5 == 0 ? 210 : 0));  // so that some writes come between
    }
    EXPECT_EQ(file.problem(), "");
  }
  std::int64_t next = last;
  for (const char* name : {"log", "log.1", "log.2"}) {
    EXPECT_LE(std::filesystem::file_size(folder_.file(name)), 100100u);
    const std::vector<WireRecord> records = read(name);
    ASSERT_GT(records.size(), 2u);
    EXPECT_EQ(records.front().event, WireEvent::kState) << "each file says the state first";
    EXPECT_EQ(stateOf(records.front().payload).mode, OperatingMode::kEnabled);
    EXPECT_EQ(records.back().time, next) << "nothing is lost between two files";
    next = records[1].time - 5000000;
  }
  EXPECT_FALSE(has("log.3"));
}

TEST_F(WireLogFileTest, oneFileIsEnough) {
  config_.size = 0.1;
  config_.files = 1;
  {
    WireLogFile file(config_, "own");
    for (int k = 0; k < 10000; ++k) file.take(turn());
    EXPECT_EQ(file.problem(), "");
  }
  EXPECT_EQ(read("log").back().time, time_);
  EXPECT_FALSE(has("log.1"));
}

void expectProblem(WireLogFile& file, const std::function<bool(const std::function<bool()>&)>& wait,
                   const std::string& part) {
  EXPECT_TRUE(wait([&] { return !file.problem().empty(); }));
  EXPECT_NE(file.problem().find(part), std::string::npos) << file.problem();
  file.take({WireEvent::kSent, 0, Bytes(10)});  // ignored
}

TEST_F(WireLogFileTest, whatIsNoFileIsLeftAlone) {
  const std::string fifo = folder_.file("fifo");
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  for (const std::string& name : {folder_.path(), fifo, std::string("/dev/null"), folder_.file("absent/log")}) {
    SCOPED_TRACE(name);
    config_.file = name;
    WireLogFile file(config_, "own");
    file.take(turn());
    expectProblem(file, waitFor, name == folder_.file("absent/log") ? "No such file" : "regular file");
  }
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

// As on a full disk: the kernel takes no more bytes.
TEST_F(WireLogFileTest, aFullDiskEndsTheRecordingAndNothingElse) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit small = before;
  small.rlim_cur = 2000;
  {
    WireLogFile file(config_, "own");
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);  // would end the process, but for the thread's mask
    for (int k = 0; k < 1000; ++k) file.take(turn());
    expectProblem(file, waitFor, "File too large");
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  }
  EXPECT_LE(std::filesystem::file_size(folder_.file("log")), 2000u);
  EXPECT_GT(read("log").size(), 50u);
}

TEST_F(WireLogFileTest, aDiskThatDoesNotKeepUpEndsTheRecording) {
  WireLogFile file(config_, "own");
  for (int k = 0; k < 40 && file.problem().empty(); ++k) file.take(turn(60000));  // 2.4 MB in no time
  EXPECT_NE(file.problem().find("keep up"), std::string::npos) << file.problem();
}

TEST(WireLogConfig, errorsAreNamed) {
  EXPECT_TRUE(validate(WireLogConfig()).empty());
  EXPECT_EQ(validate(WireLogConfig{"", std::numeric_limits<double>::quiet_NaN(), 0}).size(), 2u);
  EXPECT_EQ(validate(WireLogConfig{"", 0.01, 101}).size(), 2u);
}

}  // namespace
}  // namespace laparoscope_servo::aesop
