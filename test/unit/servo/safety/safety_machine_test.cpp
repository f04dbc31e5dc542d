#include "servo/safety/safety_machine.h"

#include <gtest/gtest.h>

#include "unit/servo/safety_facts.h"

namespace laparoscope_servo::servo {
namespace {

using namespace test;

TEST(SafetyMachine, RefusesToEngageForTheReasonThatWouldStopIt) {
  for (const std::vector<Fact>& facts : {holds(), stops(), faults()}) {
    for (const Fact& fact : facts) {
      const bool by_steps = fact.name.rfind("time 1", 0) == 0 || fact.name.rfind("time -1", 0) == 0;
      if (by_steps) continue;
      const SafetyMachine machine(strict());
      SafetyFacts input = good(0.0);
      fact.apply(input);
      EXPECT_NE(machine.refusal(input).find(fact.words), std::string::npos) << fact.name << machine.refusal(input);
    }
  }
  for (const Fact& release : releases()) {
    SafetyFacts input = good(0.0);
    release.apply(input);
    EXPECT_EQ(SafetyMachine(strict()).refusal(input), "") << release.name;
  }
  const Reached fault(State::kFault);
  EXPECT_NE(fault.machine.refusal(good(11.0)).find("disengage"), std::string::npos);
}

TEST(SafetyMachine, AsksOnlyForWhatIsRequired) {
  SafetyConfig config;
  config.robot_required = false;
  SafetyMachine machine(config);
  SafetyFacts facts = good(0.0);
  facts.robot = RobotFacts();
  facts.dead_man = {false, kInfinity};
  facts.request = EngageRequest::kOn;
  EXPECT_EQ(machine.refusal(facts), "");
  EXPECT_EQ(machine.step(facts).state, State::kServo);
  EXPECT_NE(SafetyMachine(SafetyConfig()).refusal(SafetyFacts()), "");
}

TEST(SafetyMachine, AHoldEndsWithinItsTimeOrIsLost) {
  Reached hold(State::kHold);  // since 10 s
  SafetyFacts facts = good(10.4);
  EXPECT_EQ(hold.machine.step(facts).state, State::kServo);

  Reached other(State::kHold);
  facts = good(10.4);
  facts.tracker.valid = false;  // another cause is the same hold
  EXPECT_EQ(other.machine.step(facts).state, State::kHold);
  facts.time = 10.5;
  const SafetyOutput output = other.machine.step(facts);
  EXPECT_EQ(output.state, State::kLost);
  EXPECT_NE(output.reason.find("not valid"), std::string::npos) << output.reason;
  EXPECT_EQ(other.machine.step(good(10.6)).state, State::kLost);
}

// An arm that may have been moved meanwhile does not begin to follow a region that it has never followed.
TEST(SafetyMachine, AnotherRegionIsTakenOverUnlessTheArmWasWaitedFor) {
  const Change another = [](SafetyFacts& f) { f.tracker.region = 2.0; };
  EXPECT_EQ(Reached(State::kServo).step(another).state, State::kServo);
  Reached learning(State::kServo);
  EXPECT_EQ(learning.step([](SafetyFacts& f) { f.tracker.valid = false; }).state, State::kHold);
  EXPECT_EQ(learning.step(another).state, State::kServo);
  const Change paused = [](SafetyFacts& f) { f.robot.enabled = false, f.robot.paused = true; };
  for (const bool lost_before : {false, true}) {
    Reached reached(State::kServo);
    if (lost_before) reached.step([](SafetyFacts& f) { f.tracker.valid = false; });
    EXPECT_EQ(reached.step(paused).state, State::kHold);
    const SafetyOutput output = reached.step(another);
    EXPECT_EQ(output.state, State::kLost);
    EXPECT_NE(output.reason.find("engage again"), std::string::npos) << output.reason;
  }
  Reached same(State::kServo);
  same.step(paused);
  EXPECT_EQ(same.step([](SafetyFacts& f) { f.tracker.region.reset(); }).state, State::kServo);
}

TEST(SafetyMachine, AStopThatSomebodyMadeEndsTheEngagement) {
  for (const State from : {State::kArmed, State::kServo, State::kHold}) {
    for (const Fact& stop : stops()) {
      Reached reached(from);
      EXPECT_EQ(reached.step(stop.apply).state, State::kLost) << stop.name;
      EXPECT_NE(reached.step([](SafetyFacts&) {}).reason.find("engage again"), std::string::npos);
      EXPECT_EQ(reached.machine.state(), State::kLost) << "enabled again, nobody engaged";
    }
  }
}

// The message that said so was lost, or came between two steps: the count tells.
TEST(SafetyMachine, ARobotThatWasEnabledAgainIsNotTheOneThatWasEngaged) {
  for (const std::uint32_t enables : {0u, 1u, 6u, 8u, 4294967295u}) {
    const Change again = [=](SafetyFacts& f) { f.robot.enables = enables; };
    for (const State from : {State::kArmed, State::kServo, State::kHold}) {
      Reached reached(from);
      EXPECT_EQ(reached.step(again).state, State::kLost);
      EXPECT_EQ(reached.step([&](SafetyFacts& f) { again(f), f.request = EngageRequest::kOn; }).state, State::kServo);
      EXPECT_EQ(reached.step(again).state, State::kServo) << "this count is the one that was engaged";
    }
  }
}

TEST(SafetyMachine, APauseGoesOnByAResumeWithinItsTime) {
  const Change paused = [](SafetyFacts& f) { f.robot.enabled = false, f.robot.paused = true; };
  Reached reached(State::kServo);
  EXPECT_EQ(reached.step(paused).state, State::kHold);
  EXPECT_EQ(reached.machine.step(good(10.3)).state, State::kServo);
  Reached late(State::kHold);  // paused since 10 s
  SafetyFacts facts = good(10.6);
  paused(facts);
  EXPECT_EQ(late.machine.step(facts).state, State::kLost);
  EXPECT_EQ(late.machine.step(good(10.62)).state, State::kLost);
  SafetyFacts request = good(0.0);
  paused(request);
  EXPECT_NE(SafetyMachine(strict()).refusal(request).find("paused"), std::string::npos);
}

TEST(SafetyMachine, HoldsThatFollowEachOtherDoNotAddUp) {
  Reached reached(State::kServo);
  double time = 10.0;
  for (int n = 0; n < 5; ++n) {
    SafetyFacts facts = good(time += 0.1);
    facts.tracker.valid = false;
    EXPECT_EQ(reached.machine.step(facts).state, State::kHold);
    facts.time = time += 0.4;
    EXPECT_EQ(reached.machine.step(facts).state, State::kHold);
    EXPECT_EQ(reached.machine.step(good(time += 0.05)).state, State::kServo);
  }
}

TEST(SafetyMachine, APauseIsAJumpOnlyWhileEngaged) {
  for (const State state : {State::kIdle, State::kLost, State::kFault}) {
    Reached reached(state);
    EXPECT_EQ(reached.machine.step(good(1e6)).state, state);
    EXPECT_EQ(reached.machine.step(good(-1e6)).state, state);
  }
  for (const State state : {State::kIdle, State::kLost}) {
    Reached reached(state);
    SafetyFacts facts = good(1e6);
    facts.request = EngageRequest::kOn;
    EXPECT_EQ(reached.machine.step(facts).state, State::kServo);
  }
  Reached servo(State::kServo);
  EXPECT_EQ(servo.machine.step(good(10.0)).state, State::kServo);  // twice at the same time
  EXPECT_EQ(servo.machine.step(good(10.999)).state, State::kServo);
  EXPECT_EQ(servo.machine.step(good(12.1)).state, State::kFault);
}

TEST(SafetyMachine, OcclusionSlowsThenHoldsAndResumesLater) {
  Reached reached(State::kServo);
  double time = 10.0;
  const auto step = [&](double visible) {
    SafetyFacts facts = good(time += kStep);
    facts.tracker.visible_fraction = visible;
    return reached.machine.step(facts);
  };
  EXPECT_EQ(step(1.0).speed_scale, 1.0);
  EXPECT_EQ(step(0.5).speed_scale, 1.0);
  EXPECT_EQ(step(0.5).caution, "");
  EXPECT_NEAR(step(0.35).speed_scale, 0.5, 1e-12);
  EXPECT_NE(step(0.35).caution, "");
  EXPECT_NEAR(step(0.23).speed_scale, 0.1, 1e-12);
  EXPECT_EQ(step(0.2).state, State::kServo);
  EXPECT_EQ(step(0.2).speed_scale, 0.0);
  EXPECT_EQ(step(0.199).state, State::kHold);
  EXPECT_EQ(step(0.249).state, State::kHold);  // still: no chattering about 0.2
  EXPECT_EQ(step(0.25).state, State::kServo);
  EXPECT_EQ(step(0.201).state, State::kServo);
}

TEST(SafetyMachine, TheOlderTheImageTheSlowerUntilItHolds) {
  const SafetyConfig config;
  const double slow = config.slow_age * config.max_task_error_age;
  double last = 1.0;
  for (int k = 0; k <= 100; ++k) {
    const double age = 0.01 * k * config.max_task_error_age;
    Reached reached(State::kServo);
    const SafetyOutput output = reached.step([age](SafetyFacts& f) { f.tracker.image_age = age; });
    EXPECT_EQ(output.state, State::kServo) << age;
    EXPECT_LE(output.speed_scale, last) << age;
    EXPECT_EQ(output.speed_scale == 1.0, age <= slow) << age;
    EXPECT_EQ(output.caution.empty(), output.speed_scale >= 0.5) << output.caution;
    last = output.speed_scale;
  }
  EXPECT_NEAR(last, 0.0, 1e-12);
}

TEST(SafetyMachine, TheMoreIsVisibleTheFaster) {
  double last = 0.0;
  for (int k = 20; k <= 100; ++k) {
    Reached reached(State::kServo);
    const double scale = reached.step([k](SafetyFacts& f) { f.tracker.visible_fraction = 0.01 * k; }).speed_scale;
    EXPECT_GE(scale, last);
    EXPECT_LE(scale, 1.0);
    last = scale;
  }
  EXPECT_EQ(last, 1.0);
}

TEST(SafetyMachine, GoesNoDeeperOnPoorConfidence) {
  const auto allowed = [](double visible, double corner_error) {
    Reached reached(State::kServo);
    const SafetyOutput output = reached.step([=](SafetyFacts& f) {
      f.tracker.visible_fraction = visible;
      f.tracker.corner_error = corner_error;
    });
    EXPECT_EQ(output.state, State::kServo);
    EXPECT_EQ(output.insertion_allowed, output.caution.find("not deeper") == std::string::npos);
    return output.insertion_allowed;
  };
  EXPECT_TRUE(allowed(0.5, 1.0));
  EXPECT_FALSE(allowed(0.49, 0.1));
  EXPECT_FALSE(allowed(1.0, 1.01));
  EXPECT_FALSE(allowed(1.0, kNan));
  EXPECT_FALSE(allowed(1.0, kInfinity));
}

TEST(SafetyMachine, AResidualThatGrowsIsAWarningThenAStop) {
  Reached reached(State::kServo);
  const SafetyOutput warned = reached.step([](SafetyFacts& f) { f.residual = ResidualLevel::kWarning; });
  EXPECT_EQ(warned.state, State::kServo);
  EXPECT_NE(warned.caution.find("insertion point"), std::string::npos);
  EXPECT_EQ(reached.step([](SafetyFacts& f) { f.residual = ResidualLevel::kStop; }).state, State::kFault);
}

TEST(SafetyMachine, DisengagesForTheReasonGiven) {
  Reached reached(State::kServo);
  const SafetyOutput output = reached.step([](SafetyFacts& f) {
    f.request = EngageRequest::kOff;
    f.off_reason = "the controller ends";
  });
  EXPECT_EQ(output.state, State::kIdle);
  EXPECT_EQ(output.reason, "the controller ends");
}

TEST(SafetyMachine, TheReasonStaysWhileItsCauseDoes) {
  for (const Fact& fact : holds()) {
    Reached reached(State::kServo);
    const std::string reason = reached.step(fact.apply).reason;
    Chance chance(3);
    for (int k = 2; k < 20; ++k) {
      SafetyFacts facts = good(reached.time + kStep * k);
      facts.robot.age = 0.25 * chance.uniform();
      facts.tracker.age = 0.2 * chance.uniform();
      facts.pose.d2 = 0.05 + 0.1 * chance.uniform();
      facts.tracker.visible_fraction = 0.3 + 0.7 * chance.uniform();
      fact.apply(facts);
      EXPECT_EQ(reached.machine.step(facts).reason, reason) << fact.name;
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo::servo
