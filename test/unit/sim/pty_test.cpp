#include "laparoscope_servo/sim/pty.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <memory>
#include <stdexcept>

namespace laparoscope_servo::sim {
namespace {

class PtyTest : public ::testing::Test {
 protected:
  PtyTest() {
    std::string pattern = ::testing::TempDir() + "/pty_XXXXXX";
    directory_ = ::mkdtemp(pattern.data());
    link_ = directory_ + "/port";
  }
  ~PtyTest() override {
    ::unlink(link_.c_str());
    ::rmdir(directory_.c_str());
  }
  bool exists() const {
    struct stat info {};
    return ::lstat(link_.c_str(), &info) == 0;
  }
  std::string directory_;
  std::string link_;
};

TEST_F(PtyTest, linkComesAndGoes) {
  {
    const Pty pty(link_);
    EXPECT_TRUE(exists());
    EXPECT_EQ(pty.device().rfind("/dev/", 0), 0u);
  }
  EXPECT_FALSE(exists());
}

TEST_F(PtyTest, aStaleLinkIsReplacedAndAnotherOnesLeftAlone) {
  ASSERT_EQ(::symlink("/nowhere", link_.c_str()), 0);
  auto first = std::make_unique<Pty>(link_);
  const Pty second(link_);
  first.reset();
  EXPECT_TRUE(exists()) << "the first took the second's link away";
}

TEST_F(PtyTest, aFileIsNotOverwritten) {
  std::ofstream(link_) << "precious";
  EXPECT_THROW(Pty{link_}, std::runtime_error);
  std::string text;
  std::ifstream(link_) >> text;
  EXPECT_EQ(text, "precious");
  EXPECT_THROW(Pty{directory_ + "/no/such/folder"}, std::runtime_error);
}

TEST_F(PtyTest, nobodyReadingBlocksNothing) {
  Pty pty(link_);
  for (int k = 0; k < 1000; ++k) pty.write(aesop::Bytes(100, 0x55));
  EXPECT_TRUE(pty.read().empty()) << "no echo";
}

}  // namespace
}  // namespace laparoscope_servo::sim
