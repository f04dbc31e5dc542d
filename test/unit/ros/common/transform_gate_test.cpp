#include "ros/common/transform_gate.h"

#include <gtest/gtest.h>
#include <tf2/exceptions.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <functional>
#include <limits>

namespace laparoscope_servo {
namespace {

using Transform = geometry_msgs::TransformStamped;

Transform transform(const std::string& parent, const std::string& child, double x, double stamp = 0.0) {
  Transform t;
  t.header.frame_id = parent;
  t.child_frame_id = child;
  t.header.stamp = ros::Time(stamp);
  t.transform.translation.x = x;
  t.transform.rotation.w = 1.0;
  return t;
}

// base -> arm -> tip -> camera, base -> point; arm moves, the rest is static.
class TransformGateTest : public ::testing::Test {
 protected:
  explicit TransformGateTest(const std::string& owner = "/aesop")
      : gate_({owner, "owners/tf", {"camera", "point"}, 0.25}) {}

  void moving(double x, double stamp, const std::string& sender = "/aesop") {
    movingBy(connection(sender), transform("base", "arm", x, stamp), sender);
  }
  void movingBy(const TransformGate::Connection& connection, const Transform& t, const std::string& sender = "/aesop") {
    gate_.take({t}, sender, connection, false, ros::Time(now_), steady_);
  }
  void fixed(double tip, double point, const std::string& sender = "/aesop") {
    gate_.take({transform("arm", "tip", tip), transform("tip", "camera", 0.0), transform("base", "point", point)},
               sender, connection(sender, true), true, ros::Time(now_), steady_);
  }
  TransformGate::Connection connection(const std::string& sender, bool is_static = false) {
    auto& one = connections_[sender + (is_static ? " static" : "")];
    if (!one) one = boost::make_shared<int>(0);
    return one;
  }
  void step(bool engaged, double seconds = 0.02) {
    now_ += seconds;
    steady_ += seconds;
    gate_.step(engaged, ros::Time(now_), steady_);
  }
  void start() {
    fixed(0.3, 0.5);
    moving(0.0, now_);
    step(false);
    ASSERT_EQ(problem(), "");
    ASSERT_DOUBLE_EQ(x(), 0.2);
  }
  // Of the point in the camera's frame, negated: point 0.5, arm 0, tip 0.3.
  double x() const { return gate_.buffer()->lookupTransform("camera", "point", ros::Time(0)).transform.translation.x; }
  bool isKnown() const { return gate_.buffer()->canTransform("camera", "point", ros::Time(0)); }
  std::string problem() const { return gate_.problem(steady_); }
  std::string complaint() const { return gate_.complaint(steady_); }

  double now_ = 1000.0;  // s
  double steady_ = 50.0;
  std::map<std::string, boost::shared_ptr<int>> connections_;
  TransformGate gate_;
};

TEST_F(TransformGateTest, TheOwnersAreBelieved) {
  start();
  moving(0.1, now_);
  EXPECT_DOUBLE_EQ(x(), 0.1);
  EXPECT_EQ(complaint(), "");
  EXPECT_EQ(gate_.strange() + gate_.refused(), 0u);
}

TEST_F(TransformGateTest, AStrangerChangesNothingAndIsNamed) {
  start();
  moving(0.1, now_ + 0.01, "/liar");
  EXPECT_DOUBLE_EQ(x(), 0.2);
  EXPECT_NE(complaint().find("arm of /liar"), std::string::npos) << complaint();
  EXPECT_NE(complaint().find("owners/tf"), std::string::npos) << complaint();
  EXPECT_EQ(problem(), "") << "the owner's are as good as before";
  step(false, 3.0);
  EXPECT_EQ(complaint(), "") << "it is silent now";
  fixed(0.35, 0.6, "/liar");
  EXPECT_DOUBLE_EQ(x(), 0.2);
  step(false, 100.0);
  EXPECT_NE(complaint(), "") << "what is static stays with all others who listen";
  connections_.erase("/liar static");
  EXPECT_EQ(complaint(), "");
  EXPECT_EQ(gate_.strange(), 4u);
}

TEST_F(TransformGateTest, AStrangerBeforeTheOwnerIsNotBelievedEither) {
  fixed(0.3, 0.5, "/liar");
  moving(0.0, now_, "/liar");
  EXPECT_FALSE(isKnown());
  EXPECT_NE(complaint(), "") << "camera and point are in use, whoever publishes them";
  start();
}

TEST_F(TransformGateTest, FramesThatNobodyUsesAreNobodysConcern) {
  start();
  gate_.take({transform("base", "table", 0.0, now_)}, "/other", connection("/other"), false, ros::Time(now_), steady_);
  EXPECT_EQ(complaint(), "");
  EXPECT_FALSE(gate_.buffer()->canTransform("base", "table", ros::Time(0)));
  gate_.use("table");
  gate_.take({transform("base", "/table", 0.0, now_)}, "/other", connection("/other"), false, ros::Time(now_), steady_);
  EXPECT_NE(complaint().find("table"), std::string::npos);
}

struct Nonsense {
  const char* words;
  std::function<void(Transform&)> make;
};

TEST_F(TransformGateTest, NonsenseIsAProblemUntilSomethingSensibleComes) {
  start();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Nonsense> all{
      {"not finite", [=](Transform& t) { t.transform.translation.y = nan; }},
      {"not finite", [=](Transform& t) { t.transform.rotation.w = nan; }},
      {"not finite", [](Transform& t) { t.transform.translation.y = std::numeric_limits<double>::infinity(); }},
      {"further away", [](Transform& t) { t.transform.translation.y = 1e300; }},
      {"length 1", [](Transform& t) { t.transform.rotation.w = 0.0; }},
      {"length 1", [](Transform& t) { t.transform.rotation.w = 1.01; }},
      {"future", [](Transform& t) { t.header.stamp += ros::Duration(0.3); }},
      {"no stamp", [](Transform& t) { t.header.stamp = ros::Time(); }},
      {"two parents", [](Transform& t) { t.header.frame_id = "table"; }},
      {"no parent", [](Transform& t) { t.header.frame_id = "arm"; }},
      {"no parent", [](Transform& t) { t.header.frame_id = "/"; }}};
  std::uint64_t refused = 0;
  for (const Nonsense& nonsense : all) {
    step(true);
    Transform t = transform("base", "arm", 0.1, now_);
    nonsense.make(t);
    movingBy(connection("/aesop"), t);
    EXPECT_NE(problem().find(nonsense.words), std::string::npos) << nonsense.words << " is not in: " << problem();
    EXPECT_NE(problem().find("arm"), std::string::npos);
    EXPECT_DOUBLE_EQ(x(), 0.2) << nonsense.words;
    EXPECT_EQ(gate_.refused(), ++refused);
    moving(0.0, now_);
    EXPECT_EQ(problem(), "") << nonsense.words;
  }
}

TEST_F(TransformGateTest, AFrameIsStaticOrMovesNotBoth) {
  start();
  gate_.take({transform("base", "arm", 0.1)}, "/aesop", connection("/aesop", true), true, ros::Time(now_), steady_);
  EXPECT_DOUBLE_EQ(x(), 0.2);
  movingBy(connection("/aesop", true), transform("base", "point", 0.7, now_));
  EXPECT_NE(problem().find("static, and moves"), std::string::npos) << problem();
  EXPECT_DOUBLE_EQ(x(), 0.2);
}

TEST_F(TransformGateTest, StampsGoForward) {
  start();
  const double last = now_ - 0.02;
  moving(0.1, last);  // the same stamp, other content
  moving(0.1, last - 1.0);
  EXPECT_DOUBLE_EQ(x(), 0.2);
  EXPECT_EQ(gate_.refused(), 2u);
  moving(0.0, last);  // told again
  EXPECT_EQ(gate_.refused(), 2u);
  EXPECT_EQ(problem(), "");
}

TEST_F(TransformGateTest, ARecordingThatBeginsAgainIsBelievedWhenNobodyIsEngaged) {
  start();
  for (int k = 0; k < 300; ++k) {
    step(true);
    moving(0.1, 500.0 + 0.02 * k);
  }
  EXPECT_DOUBLE_EQ(x(), 0.2);
  step(false);
  moving(0.1, 600.0);
  EXPECT_DOUBLE_EQ(x(), 0.1);
  moving(0.15, 600.02);
  EXPECT_NEAR(x(), 0.05, 1e-12);
}

TEST_F(TransformGateTest, WhatIsStaticMayNotChangeWhileEngaged) {
  start();
  step(true);
  fixed(0.3, 0.5);  // told again
  EXPECT_EQ(gate_.takeChangedFrame(), "");
  fixed(0.3, 0.6);
  EXPECT_EQ(gate_.takeChangedFrame(), "point");
  EXPECT_EQ(gate_.takeChangedFrame(), "") << "once";
  EXPECT_DOUBLE_EQ(x(), 0.2) << "the arm goes by the old one until somebody has looked";
  step(false);
  EXPECT_DOUBLE_EQ(x(), 0.3) << "it was told once, and must not be lost";
  EXPECT_EQ(gate_.takeChangedFrame(), "point");
  step(true);
  fixed(0.25, 0.6);
  EXPECT_EQ(gate_.takeChangedFrame(), "tip") << "every frame between camera and root";
}

TEST_F(TransformGateTest, WhatIsStaticGoesWithItsConnection) {
  start();
  connections_.erase("/aesop static");
  step(true);
  EXPECT_FALSE(isKnown());
  fixed(0.3, 0.5);
  EXPECT_DOUBLE_EQ(x(), 0.2);
  EXPECT_EQ(gate_.takeChangedFrame(), "") << "the same again";
  connections_.erase("/aesop static");
  step(true);
  fixed(0.35, 0.5);
  EXPECT_EQ(gate_.takeChangedFrame(), "tip");
  EXPECT_FALSE(isKnown());
  step(false);
  EXPECT_NEAR(x(), 0.15, 1e-12);
}

TEST_F(TransformGateTest, AFrameThatWasStaticAtEngagingDoesNotMoveLater) {
  start();
  step(true);
  connections_.erase("/aesop static");
  step(true);
  movingBy(connection("/aesop"), transform("base", "point", 0.5, now_));
  EXPECT_EQ(gate_.takeChangedFrame(), "point");
}

TEST_F(TransformGateTest, OfTwoProcessesOfOneNameNobodyKnowsWhichIsRight) {
  start();
  const TransformGate::Connection second = boost::make_shared<int>(0);
  movingBy(second, transform("base", "arm", 0.1, now_));
  EXPECT_DOUBLE_EQ(x(), 0.2);
  EXPECT_NE(problem().find("another process"), std::string::npos) << problem();
  connections_.erase("/aesop");
  step(true, 0.1);
  movingBy(second, transform("base", "arm", 0.1, now_));
  EXPECT_DOUBLE_EQ(x(), 0.1) << "the first one is gone";
}

TEST_F(TransformGateTest, AStaticTransformOfTheNewProcessWaitsForTheEndOfTheOld) {
  start();
  const TransformGate::Connection second = boost::make_shared<int>(0);
  gate_.take({transform("base", "point", 0.6)}, "/aesop", second, true, ros::Time(now_), steady_);
  EXPECT_DOUBLE_EQ(x(), 0.2);
  connections_.erase("/aesop static");
  step(false);
  EXPECT_EQ(gate_.takeChangedFrame(), "point");
  fixed(0.3, 0.5);
  EXPECT_NEAR(x(), 0.3, 1e-12);
}

TEST_F(TransformGateTest, AStaticTransformWaitsForTheSilenceOfOneThatMoves) {
  start();
  const TransformGate::Connection second = boost::make_shared<int>(0);
  gate_.take({transform("base", "arm", 0.1)}, "/aesop", second, true, ros::Time(now_), steady_);
  step(false);
  EXPECT_DOUBLE_EQ(x(), 0.2);
  step(true, 10.0);
  EXPECT_DOUBLE_EQ(x(), 0.2) << "not while engaged";
  step(false);
  EXPECT_DOUBLE_EQ(x(), 0.1);
}

TEST_F(TransformGateTest, TimeThatJumpsBackLeavesWhatIsStatic) {
  start();
  gate_.clear();
  EXPECT_FALSE(isKnown());
  moving(0.1, 900.0);
  EXPECT_DOUBLE_EQ(x(), 0.1);
}

class WithoutOwner : public TransformGateTest {
 protected:
  WithoutOwner() : TransformGateTest("") {}
};

TEST_F(WithoutOwner, TheFirstCountsAndTheSecondIsAProblem) {
  start();
  moving(0.1, now_, "/other");
  EXPECT_DOUBLE_EQ(x(), 0.2);
  EXPECT_NE(problem().find("/other"), std::string::npos) << problem();
  EXPECT_NE(problem().find("/aesop"), std::string::npos) << problem();
}

TEST_F(WithoutOwner, WhoIsSilentIsReplacedOnlyWhenNobodyIsEngaged) {
  start();
  step(true, 10.0);
  moving(0.1, now_, "/other");
  EXPECT_DOUBLE_EQ(x(), 0.2);
  step(false);
  moving(0.1, now_, "/other");
  EXPECT_DOUBLE_EQ(x(), 0.1);
}

TEST_F(WithoutOwner, FramesOfManyDoNotFillTheMemory) {
  start();
  for (int k = 0; k < 3000; ++k) {
    gate_.take({transform("base", "frame_" + std::to_string(k), 0.0, now_)}, "/other", connection("/other"), false,
               ros::Time(now_), steady_);
  }
  EXPECT_GT(gate_.refused(), 1500u);
  EXPECT_DOUBLE_EQ(x(), 0.2);
}

}  // namespace
}  // namespace laparoscope_servo
