#include "sim/arm/pty.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <memory>
#include <stdexcept>

#include "support/temporary_folder.h"

namespace laparoscope_servo::sim {
namespace {

class PtyTest : public ::testing::Test {
 protected:
  bool exists() const {
    struct stat info {};
    return ::lstat(link_.c_str(), &info) == 0;
  }
  const test_support::TemporaryFolder folder_;
  const std::string link_ = folder_.file("port");
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
  EXPECT_THROW(Pty{folder_.file("no/such/folder")}, std::runtime_error);
}

TEST_F(PtyTest, nobodyReadingBlocksNothing) {
  Pty pty(link_);
  for (int k = 0; k < 1000; ++k) pty.write(aesop::Bytes(100, 0x55));
  EXPECT_TRUE(pty.read().empty()) << "no echo";
}

}  // namespace
}  // namespace laparoscope_servo::sim
