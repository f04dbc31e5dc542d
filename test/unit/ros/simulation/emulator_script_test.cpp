#include "ros/simulation/emulator_script.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "ros/common/parameters.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

class EmulatorScriptTest : public ::testing::Test {
 protected:
  std::vector<sim::ScheduledFault> read(const std::string& yaml) {
    std::ofstream(file_) << yaml;
    errors_.clear();
    return readScript(parametersFromYaml(file_), errors_);
  }
  // Whether the only error begins like this.
  bool refuses(const std::string& yaml, const std::string& beginning) {
    read(yaml);
    return errors_.size() == 1 && errors_[0].rfind(beginning, 0) == 0;
  }
  std::string all() const {
    std::string text;
    for (const std::string& error : errors_) text += error + "\n";
    return text;
  }

  test_support::TemporaryFolder folder_;
  std::string file_ = folder_.file("script.yaml");
  std::vector<std::string> errors_;
};

TEST_F(EmulatorScriptTest, timesNamesAndValues) {
  const auto script = read(
      "script:\n"
      "  - {at: 1, fault: drop, value: 0.01, way: to_host, for: 2.5}\n"
      "  - {after: 0.5, fault: lie, value: frozen}\n"
      "  - {after: 2, fault: bits, value: 3}\n"
      "  - {at: 0.25, fault: reboot}\n");
  ASSERT_TRUE(errors_.empty()) << all();
  ASSERT_EQ(script.size(), 4u);
  EXPECT_EQ(script[0].at, 1.0);
  EXPECT_EQ(script[0].fault.name, "drop");
  EXPECT_EQ(script[0].fault.value, "0.01");
  EXPECT_EQ(script[0].fault.way, "to_host");
  EXPECT_EQ(script[0].fault.duration, 2.5);
  EXPECT_EQ(script[1].at, 1.5);
  EXPECT_EQ(script[1].fault.value, "frozen");
  EXPECT_TRUE(std::isinf(script[1].fault.duration));
  EXPECT_EQ(script[2].at, 3.5);
  EXPECT_EQ(script[2].fault.value, "3");
  EXPECT_EQ(script[3].at, 0.25);
}

TEST_F(EmulatorScriptTest, whatIsWrongIsNamedWithItsEntry) {
  EXPECT_TRUE(refuses("", "expected 'script:'")) << all();
  EXPECT_TRUE(refuses("script: 5", "expected 'script:'")) << all();
  EXPECT_TRUE(refuses("{script: [], loop: true}", "there is no 'loop'")) << all();
  EXPECT_TRUE(refuses("script: [7]", "entry 1: it is no mapping")) << all();
  EXPECT_TRUE(refuses("script: [{at: 1, fault: reboot}, {fault: reboot}]", "entry 2: expected either at or after"));
  EXPECT_TRUE(refuses("script: [{at: 1, after: 1, fault: reboot}]", "entry 1: expected either at or after")) << all();
  EXPECT_TRUE(refuses("script: [{at: -1, fault: reboot}]", "entry 1: at = -1")) << all();
  EXPECT_TRUE(refuses("script: [{at: soon, fault: reboot}]", "entry 1: at = soon")) << all();
  EXPECT_TRUE(refuses("script: [{at: 1}]", "entry 1: expected fault")) << all();
  EXPECT_TRUE(refuses("script: [{at: 1, fault: rust}]", "entry 1: there is no fault 'rust'")) << all();
  EXPECT_TRUE(refuses("script: [{at: 1, fault: drop}]", "entry 1: drop takes")) << all();
  EXPECT_TRUE(refuses("script: [{at: 1, fault: drop, value: [1]}]", "entry 1: value")) << all();
  EXPECT_TRUE(refuses("script: [{at: 1, fault: drop, value: 0.1, way: up}]", "entry 1: 'up'")) << all();
  EXPECT_TRUE(refuses("script: [{at: 1, fault: drop, value: 0.1, for: 0}]", "entry 1: a fault lasts")) << all();
  EXPECT_TRUE(refuses("script: [{at: 1, fault: reboot, fro: 1}]", "entry 1: there is no 'fro'")) << all();
}

TEST_F(EmulatorScriptTest, aFileNamesItselfAndAllItsErrors) {
  std::ofstream(file_) << "script: [{at: 1, fault: rust}, {at: 2, fault: drop, value: 2}]";
  try {
    scriptFromYaml(file_);
    FAIL();
  } catch (const std::runtime_error& error) {
    for (const char* what : {file_.c_str(), "entry 1", "'rust'", "entry 2", "probability"}) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << what << ": " << error.what();
    }
  }
}

TEST_F(EmulatorScriptTest, theShippedExampleIsOne) {
  EXPECT_GT(scriptFromYaml(std::string(LAPAROSCOPE_SERVO_CONFIG) + "/emulator_faults.yaml").size(), 5u);
}

}  // namespace
}  // namespace laparoscope_servo
