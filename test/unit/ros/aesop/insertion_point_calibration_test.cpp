// Calibrations of the insertion point: what comes of them, and what they refuse.
#include "ros/aesop/insertion_point_calibration.h"

#include "unit/ros/calibration_loop.h"

namespace laparoscope_servo {
namespace {

TEST_F(CalibrationTest, ByHand) {
  connect();
  ASSERT_EQ(calibration_.start(Method::kHand, now_), "");
  swing(0.13);
  EXPECT_EQ(calibration_.message(), "enough; finish, or go on");
  ASSERT_EQ(calibration_.finish(now_), "");
  EXPECT_EQ(calibration_.stage(), Stage::kDone);
  run(0.1);
  expectCalibrated();
  EXPECT_EQ(loadInsertionPoint(parameters().file, driver_.kinematics()).method, "HAND");
  EXPECT_EQ(driver_.state(now_).mode, OperatingMode::kDisabled);
}

TEST_F(CalibrationTest, ByPattern) {
  startPattern();
  run(15.0);
  EXPECT_EQ(calibration_.stage(), Stage::kDone) << calibration_.message();
  expectCalibrated();
  EXPECT_EQ(loadInsertionPoint(parameters().file, driver_.kinematics()).method, "PATTERN");
  EXPECT_EQ(driver_.state(now_).mode, OperatingMode::kDisabled);
  // About the new point, the arm drives as ever.
  enable();
  EXPECT_EQ(driver_.command({0.05, 0.0, 0.0, 0.0}, stamp(), stamp(), now_), "");
  run(0.3);
  EXPECT_FALSE(emulator_.arm().velocity().isZero(0.0));
}

TEST_F(CalibrationTest, AnotherOneStartsAfresh) {
  connect();
  ASSERT_EQ(calibration_.start(Method::kHand, now_), "");
  EXPECT_NE(calibration_.start(Method::kHand, now_).find("under way"), std::string::npos);
  swing(0.13);
  ASSERT_EQ(calibration_.finish(now_), "");
  EXPECT_EQ(calibration_.finish(now_), "no calibration is under way");
  EXPECT_EQ(calibration_.cancel(now_), "no calibration is under way");
  ASSERT_EQ(calibration_.start(Method::kHand, now_), "");
  EXPECT_EQ(calibration_.fit().poses, 0);
  EXPECT_NE(calibration_.finish(now_), "");
}

TEST_F(CalibrationTest, TooLittleMotionIsRefusedAndMayGoOn) {
  connect();
  ASSERT_EQ(calibration_.start(Method::kHand, now_), "");
  run(2.0);
  EXPECT_NE(calibration_.finish(now_).find("poses of different directions: 1, expected at least 30"), std::string::npos)
      << calibration_.finish(now_);
  swing(0.04);
  const std::string small = calibration_.finish(now_);
  EXPECT_NE(small.find("the shaft has turned by 0.02"), std::string::npos) << small;
  EXPECT_NE(small.find("expected at least 0.07 rad"), std::string::npos) << small;
  EXPECT_EQ(calibration_.stage(), Stage::kCollecting);
  EXPECT_EQ(driver_.insertionPoint(), kBelieved);
  swing(0.15);
  EXPECT_EQ(calibration_.finish(now_), "");
}

TEST_F(CalibrationTest, ACancelledOneLeavesThePointAsItWas) {
  connect();
  ASSERT_EQ(calibration_.start(Method::kHand, now_), "");
  swing(0.13);
  ASSERT_EQ(calibration_.cancel(now_), "");
  expectStandingAndUnchanged("cancelled");
}

TEST_F(CalibrationTest, AnEnableEndsOneByHand) {
  connect();
  ASSERT_EQ(calibration_.start(Method::kHand, now_), "");
  swing(0.13);
  ASSERT_EQ(driver_.enable(stamp(), now_), "");
  run(0.3);
  EXPECT_EQ(calibration_.stage(), Stage::kFailed);
  EXPECT_NE(calibration_.message().find("the arm is ENABLED"), std::string::npos) << calibration_.message();
  EXPECT_EQ(driver_.insertionPoint(), kBelieved);
}

TEST_F(CalibrationTest, AFileThatCannotBeWrittenKeepsTheOldPointAndThePoses) {
  connect();
  std::filesystem::create_directory(parameters().file);
  ASSERT_EQ(calibration_.start(Method::kHand, now_), "");
  swing(0.13);
  EXPECT_NE(calibration_.finish(now_).find("'" + parameters().file + "' cannot be written"), std::string::npos);
  run(0.1);
  EXPECT_EQ(driver_.insertionPoint(), kBelieved);
  std::filesystem::remove(parameters().file);
  EXPECT_EQ(calibration_.finish(now_), "");
  run(0.1);
  EXPECT_EQ(driver_.insertionPoint(), calibration_.fit().point);
}

TEST_F(CalibrationTest, TheNewPointWaitsForAnArmThatIsDisabledAndAtRest) {
  connect();
  ASSERT_EQ(calibration_.start(Method::kHand, now_), "");
  swing(0.13);
  ASSERT_EQ(emulator_.hand({0.05, 0.0, 0.0, 0.0}, 1.0, now_), "");
  run(0.3);
  ASSERT_EQ(calibration_.finish(now_), "");
  run(0.3);
  EXPECT_EQ(driver_.insertionPoint(), kBelieved) << "the scope is in motion";
  EXPECT_TRUE(calibration_.waits());
  run(1.0);
  EXPECT_FALSE(calibration_.waits());
  EXPECT_EQ(driver_.insertionPoint(), calibration_.fit().point);
  enable();
  EXPECT_NE(driver_.setInsertionPoint(kBelieved).find("the arm is ENABLED"), std::string::npos);
  EXPECT_EQ(driver_.insertionPoint(), calibration_.fit().point);
}

TEST_F(CalibrationTest, ThePatternHasToBeAllowed) {
  enable();
  InsertionPointCalibration calibration(CalibrationParameters(), driver_);
  EXPECT_NE(calibration.start(Method::kPattern, now_).find("pattern_allowed"), std::string::npos);
  run(1.0);
  EXPECT_TRUE(emulator_.arm().velocity().isZero(0.0));
}

TEST_F(CalibrationTest, StartIsRefusedInTheWrongState) {
  EXPECT_NE(calibration_.start(Method::kHand, now_).find("not connected"), std::string::npos);
  connect();
  EXPECT_NE(calibration_.start(Method::kPattern, now_).find("has to be ENABLED"), std::string::npos);
  enable();
  EXPECT_NE(calibration_.start(Method::kHand, now_).find("has to be DISABLED"), std::string::npos);
  ASSERT_EQ(driver_.command({0.05, 0.0, 0.0, 0.0}, stamp(), stamp(), now_), "");
  EXPECT_NE(calibration_.start(Method::kPattern, now_).find("at rest"), std::string::npos);
  EXPECT_EQ(calibration_.stage(), Stage::kIdle);
}

class NarrowPatternTest : public CalibrationTest {
 protected:
  NarrowPatternTest() : CalibrationTest(0.04) {}
};

TEST_F(NarrowPatternTest, APatternThatShowsTooLittleIsRefused) {
  startPattern();
  run(12.0);
  expectStandingAndUnchanged("the shaft has turned by 0.0");
}

}  // namespace
}  // namespace laparoscope_servo
