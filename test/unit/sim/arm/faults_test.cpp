#include "laparoscope_servo/sim/faults.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::sim {
namespace {

class FaultsTest : public ::testing::Test {
 protected:
  static Fault fault(const std::string& name, const std::string& value = "", const std::string& way = "") {
    Fault result;
    result.name = name;
    result.value = value;
    result.way = way;
    return result;
  }
  static Fault lasting(Fault result, double duration) {
    result.duration = duration;
    return result;
  }
  Emulator emulator_{EmulatorConfig(), 0.0};
  Wire wire_{1};
  Faults faults_{emulator_, wire_};
};

TEST_F(FaultsTest, eachBeginsAndEndsByItself) {
  const Fault all[] = {fault("drop", "0.1"),  fault("corrupt", "0.1"), fault("double", "0.1"), fault("delay", "0.1"),
                       fault("stall"),        fault("hangup"),         fault("bits", "1"),     fault("joint", "2"),
                       fault("stalled", "2"), fault("reversed", "2"),  fault("gain", "2"),     fault("lag", "0.1"),
                       fault("lie", "frozen")};
  for (const Fault& one : all) EXPECT_EQ(faults_.begin(lasting(one, 1.0), 0.0), "") << one.name;
  const WireFaults& line = wire_.to_host.faults;
  EXPECT_EQ(line.drop + line.corrupt + line.duplicate + line.delay, 0.4);
  EXPECT_GT(line.stalled_until, 1e6);
  EXPECT_TRUE(wire_.isCut(0.5));
  EXPECT_EQ(emulator_.state(), aesop::RobotState::kFault);
  EXPECT_EQ(faults_.next(), 1.0);
  faults_.step(1.0);
  EXPECT_EQ(line.drop + line.corrupt + line.duplicate + line.delay, 0.0);
  EXPECT_LE(line.stalled_until, 1.0);
  EXPECT_FALSE(wire_.isCut(1.0));
  emulator_.reboot(1.0);
  EXPECT_EQ(emulator_.state(), aesop::RobotState::kDisabled) << "the cause has gone";
  EXPECT_GT(faults_.next(), 1e6);
}

TEST_F(FaultsTest, oneWayLeavesTheOtherAlone) {
  faults_.begin(fault("stall", "", "to_host"), 0.0);
  faults_.begin(fault("drop", "0.5", "to_controller"), 0.0);
  EXPECT_LT(wire_.to_controller.faults.stalled_until, 0.0);
  EXPECT_GT(wire_.to_host.faults.stalled_until, 1e6);
  EXPECT_EQ(wire_.to_host.faults.drop, 0.0);
  EXPECT_EQ(wire_.to_controller.faults.drop, 0.5);
}

TEST_F(FaultsTest, inTheOrderOfTheirTimes) {
  EXPECT_EQ(faults_.schedule({2.0, fault("drop", "0.2")}, 10.0), "");
  EXPECT_EQ(faults_.schedule({1.0, lasting(fault("drop", "0.1"), 0.5)}, 10.0), "");
  EXPECT_EQ(faults_.next(), 11.0);
  faults_.step(10.9);
  EXPECT_EQ(wire_.to_host.faults.drop, 0.0);
  faults_.step(11.0);
  EXPECT_EQ(wire_.to_host.faults.drop, 0.1);
  EXPECT_EQ(faults_.next(), 11.5);
  faults_.step(20.0);
  EXPECT_EQ(wire_.to_host.faults.drop, 0.2);
  faults_.begin(fault("none"), 20.0);
  EXPECT_EQ(wire_.to_host.faults.drop, 0.0);
}

TEST_F(FaultsTest, whatCannotBeIsRefusedByName) {
  const auto problem = [](const Fault& f) { return error(f); };
  EXPECT_NE(problem(fault("rust")).find("'rust'"), std::string::npos);
  EXPECT_NE(problem(fault("drop", "2")).find("probability"), std::string::npos);
  EXPECT_NE(problem(fault("drop", "nan")).find("'nan'"), std::string::npos);
  EXPECT_NE(problem(fault("lie", "white")).find("echo_frozen"), std::string::npos);
  EXPECT_NE(problem(fault("drop", "0.1", "up")).find("'up'"), std::string::npos);
  EXPECT_NE(problem(fault("gain", "11")).find("factor"), std::string::npos);
  EXPECT_NE(problem(fault("lag", "-1")).find("10 s"), std::string::npos);
  EXPECT_NE(problem(fault("bits", "1", "to_host")), "");
  EXPECT_NE(problem(fault("reboot", "1")), "");
  EXPECT_NE(problem(lasting(fault("reboot"), 1.0)), "");
  EXPECT_NE(problem(lasting(fault("stall"), 0.0)), "");
  EXPECT_NE(problem(lasting(fault("stall"), std::numeric_limits<double>::quiet_NaN())), "");
  EXPECT_NE(faults_.schedule({-1.0, fault("none")}, 0.0), "");
  EXPECT_NE(faults_.schedule({1.0, fault("rust")}, 0.0), "");
  EXPECT_NE(faults_.begin(fault("joint", "8"), 0.0), "");
  EXPECT_GT(faults_.next(), 1e6) << "nothing of that happens";
}

}  // namespace
}  // namespace laparoscope_servo::sim
