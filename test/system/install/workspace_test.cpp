// The workspace that the package is built in, as rosrun sees it.
#include <gtest/gtest.h>

#include "support/command_output.h"

namespace laparoscope_servo::test_support {
namespace {

CommandOutput inTheWorkspace(const std::string& command) {
  return outputOf("env -i HOME=\"$HOME\" PATH=/usr/bin:/bin bash -c 'source \"" DEVEL "/setup.bash\" && " + command +
                  "' </dev/null");
}

TEST(Workspace, rosrunFindsAProgramOnceAndHasNothingToSay) {
  const CommandOutput run = inTheWorkspace("rosrun --prefix echo laparoscope_servo track_bag");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.text, DEVEL "/lib/laparoscope_servo/track_bag\n");
}

// rosrun looks for programs below the package, through links: what is built or installed in the workspace must not be
// there.
TEST(Workspace, thePackageDoesNotLeadIntoItself) {
  const CommandOutput found = inTheWorkspace("find -L \"$(rospack find laparoscope_servo)\" \\( -samefile \"" DEVEL
                                             "\" -o -type f -name track_bag \\) ! -path \"*/build/*\"");
  EXPECT_EQ(found.status, 0) << "find says so when it meets a loop";
  EXPECT_EQ(found.text, "");
  EXPECT_EQ(inTheWorkspace("ls \"$(rospack find laparoscope_servo)/package.xml\" >/dev/null").text, "");
}

}  // namespace
}  // namespace laparoscope_servo::test_support
