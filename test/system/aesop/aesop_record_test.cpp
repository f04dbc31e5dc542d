// The node records its line; the tool prints the recording and replays it.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "support/temporary_folder.h"
#include "system/aesop/aesop_bench.h"

namespace laparoscope_servo::test {
namespace {

class AesopRecord : public testing::Test {
 protected:
  // What the tool says; its exit status has to be `status`.
  std::string tool(const std::vector<std::string>& arguments, int status) {
    const std::string output = folder_.file("output");
    ChildProcess process(WIRE_LOG, arguments, output);
    EXPECT_EQ(process.exitStatus(20.0), status);
    std::ostringstream text;
    text << std::ifstream(output).rdbuf();
    last_ = text.str();
    return last_;
  }
  bool says(const std::string& part) const { return last_.find(part) != std::string::npos; }

  test_support::TemporaryFolder folder_;
  std::string last_;
};

TEST_F(AesopRecord, aSessionReplaysToTheSameStates) {
  const std::string log = folder_.file("wire.log");
  AesopBench bench(false);
  bench.wire_log_ = log;
  bench.startNode();
  ASSERT_TRUE(bench.startMoving());
  bench.truth().fault("corrupt", 0.002);
  bench.commandUntil([] { return false; }, -0.05, 1.0);
  bench.truth().fault("none");
  bench.commandUntil([] { return false; }, 0.05, 0.3);
  bench.node().kill(SIGTERM);
  ASSERT_EQ(bench.node().exitStatus(5.0), 0);

  tool({log}, 0);
  for (const char* part : {"port opened", "> #1 identify", "'EMULATED AESOP'", "asked to enable", "state ENABLED homed",
                           "velocity for 0.2 s:", "asked to disable", "turns of the driver", "round trips"}) {
    EXPECT_TRUE(says(part)) << part;
  }
  tool({log, "--replay"}, 0);
  EXPECT_TRUE(says("ENABLED homed busy")) << last_;
  EXPECT_TRUE(says("other bytes than recorded in 0, another state after 0")) << last_;

  const std::string params = folder_.file("params.yaml");
  std::ofstream(params) << "command: {timeout: 0.02}\n";
  tool({log, "--replay", "--summary", "--params", params}, 1);
  EXPECT_TRUE(says("other --params")) << last_;
}

TEST_F(AesopRecord, aRecordingThatCannotBeDoesNotStopTheArm) {
  AesopBench bench(false);
  bench.wire_log_ = folder_.file("absent/wire.log");
  bench.startNode();
  EXPECT_TRUE(bench.startMoving());
  EXPECT_TRUE(bench.waitFor([&] {
    return bench.diagnostics_ && bench.diagnostics_->message.find("absent/wire.log' has ended") != std::string::npos;
  }));
}

TEST_F(AesopRecord, theToolNamesWhatIsWrong) {
  EXPECT_NE(tool({}, 2).find("no recording is given"), std::string::npos);
  EXPECT_NE(tool({"--help"}, 0).find("--replay"), std::string::npos);
  EXPECT_NE(tool({folder_.file("nothing")}, 1).find("cannot be read"), std::string::npos);
  const std::string text = folder_.file("text");
  std::ofstream(text) << "some text";
  EXPECT_NE(tool({text}, 1).find("this is no wire log"), std::string::npos);
  EXPECT_NE(tool({text, "--codec", "vendor"}, 1).find("expected one of: own"), std::string::npos);
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  return laparoscope_servo::test::runBenchTests(argc, argv, "aesop_record_test");
}
