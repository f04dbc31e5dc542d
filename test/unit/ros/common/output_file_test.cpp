#include "ros/common/output_file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <filesystem>
#include <iterator>
#include <stdexcept>

#include "support/error_text.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

using test_support::errorText;

namespace fs = std::filesystem;

std::string contentOf(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t filesIn(const std::string& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

void print(std::ostream& stream) {
  stream << "new";
}

class OutputFileTest : public testing::Test {
 protected:
  const test_support::TemporaryFolder folder_;
  const std::string name_ = folder_.file("out.csv");
};

TEST_F(OutputFileTest, IsThereUnderItsNameOnceItIsKept) {
  std::ofstream(name_) << "old";
  {
    TextFile file(name_);
    file.write(print);
    EXPECT_EQ(contentOf(name_), "old");
  }
  EXPECT_EQ(contentOf(name_), "old") << "was never kept";
  EXPECT_EQ(filesIn(folder_.path()), 1u);
  writeTextFile(name_, print);
  EXPECT_EQ(contentOf(name_), "new");
  EXPECT_EQ(filesIn(folder_.path()), 1u);
}

TEST_F(OutputFileTest, OverwritesWhatAKilledRunLeft) {
  std::ofstream(name_ + ".partial") << "rubbish that is longer";
  writeTextFile(name_, print);
  EXPECT_EQ(contentOf(name_), "new");
  EXPECT_EQ(filesIn(folder_.path()), 1u);
}

TEST_F(OutputFileTest, KeepsTheRightsOfWhatItReplaces) {
  std::ofstream(name_) << "old";
  ASSERT_EQ(::chmod(name_.c_str(), 0640), 0);
  writeTextFile(name_, print);
  struct stat now {};
  ASSERT_EQ(::stat(name_.c_str(), &now), 0);
  EXPECT_EQ(now.st_mode & 07777, 0640u);
}

TEST_F(OutputFileTest, FollowsLinks) {
  fs::create_directory(folder_.file("elsewhere"));
  fs::create_symlink("elsewhere/target.csv", name_);
  for (const char* round : {"target is new", "target exists"}) {
    writeTextFile(name_, print);
    EXPECT_TRUE(fs::is_symlink(name_)) << round;
    EXPECT_EQ(contentOf(folder_.file("elsewhere/target.csv")), "new") << round;
    EXPECT_EQ(filesIn(folder_.file("elsewhere")), 1u) << round;
  }
  fs::create_symlink("circle", folder_.file("circle"));
  EXPECT_NE(errorText<std::runtime_error>([&] { writeTextFile(folder_.file("circle"), print); }).find("circle"),
            std::string::npos);
}

TEST_F(OutputFileTest, NamesWhatCannotBeWritten) {
  const auto expectError = [](const std::string& name, const std::string& part) {
    const std::string error = errorText<std::runtime_error>([&] { writeTextFile(name, print); });
    EXPECT_NE(error.find("'" + name + "' cannot be written"), std::string::npos) << error;
    EXPECT_NE(error.find(part), std::string::npos) << error;
  };
  expectError(folder_.file("no/such/folder/out.csv"), "No such file");
  expectError(folder_.path(), "it is a folder");
  expectError("/dev/full", "No space left");
}

TEST_F(OutputFileTest, WritesToADeviceAsItIs) {
  writeTextFile("/dev/null", print);
  EXPECT_FALSE(fs::is_regular_file("/dev/null"));
  EXPECT_FALSE(fs::exists("/dev/null.partial"));
}

TEST_F(OutputFileTest, AFullDiskLeavesWhatWasThere) {
  std::ofstream(name_) << "old";
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto on_signal = ::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 10000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string error = errorText<std::runtime_error>(
      [&] { writeTextFile(name_, [](std::ostream& stream) { stream << std::string(100000, 'x'); }); });
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, on_signal);
  EXPECT_NE(error.find("File too large"), std::string::npos) << error;
  EXPECT_EQ(contentOf(name_), "old");
  EXPECT_EQ(filesIn(folder_.path()), 1u);
}

}  // namespace
}  // namespace laparoscope_servo
