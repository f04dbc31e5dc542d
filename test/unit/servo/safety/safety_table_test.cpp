// The table of the safety states: each row, their order, and all of them under random facts.
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <utility>

#include "servo/safety/safety_machine.h"
#include "unit/servo/safety_facts.h"

namespace laparoscope_servo::servo {
namespace {

using namespace test;

using Condition = SafetyCondition;

// The whole behaviour, a line for a kind of fact: where each state leads, in the order of kSafetyStates.
struct Line {
  std::vector<Fact> facts;
  EngageRequest request;
  std::vector<State> to;
};

std::vector<Line> behaviour() {
  const State idle = State::kIdle;
  const State armed = State::kArmed;
  const State servo = State::kServo;
  const State hold = State::kHold;
  const State lost = State::kLost;
  const State fault = State::kFault;
  const std::vector<Fact> nothing{{"nothing", [](SafetyFacts&) {}}};
  const EngageRequest none = EngageRequest::kNone;
  const EngageRequest on = EngageRequest::kOn;
  const EngageRequest off = EngageRequest::kOff;
  return {
      // from:            IDLE   ARMED  SERVO  HOLD   LOST   FAULT
      {nothing, none, {idle, servo, servo, servo, lost, fault}},
      {releases(), none, {idle, armed, armed, armed, lost, fault}},
      {holds(), none, {idle, hold, hold, hold, lost, fault}},
      {stops(), none, {idle, lost, lost, lost, lost, fault}},
      {faults(), none, {idle, fault, fault, fault, lost, fault}},
      {nothing, on, {servo, servo, servo, servo, servo, fault}},
      {releases(), on, {armed, armed, armed, armed, armed, fault}},
      {holds(), on, {idle, hold, hold, hold, lost, fault}},
      {stops(), on, {idle, lost, lost, lost, lost, fault}},
      {faults(), on, {idle, fault, fault, fault, lost, fault}},
      {nothing, off, {idle, idle, idle, idle, idle, idle}},
      {releases(), off, {idle, idle, idle, idle, idle, idle}},
      {holds(), off, {idle, idle, idle, idle, idle, idle}},
      {stops(), off, {idle, idle, idle, idle, idle, idle}},
      {faults(), off, {idle, fault, fault, fault, idle, idle}},
  };
}

TEST(SafetyMachine, EachFactLeadsFromEachStateWhereItShould) {
  for (const Line& line : behaviour()) {
    for (const Fact& fact : line.facts) {
      for (const State from : kSafetyStates) {
        SCOPED_TRACE(fact.name + " in " + nameOf(from) + ", request " + std::to_string(static_cast<int>(line.request)));
        // Idle, a machine knows no time to compare with: a pause is no jump.
        if (fact.name == "time 1000000000.000000" && !isEngaged(from)) continue;
        if (fact.name == "time -1.000000" && !isEngaged(from)) continue;
        Reached reached(from);
        const SafetyOutput output = reached.step([&](SafetyFacts& facts) {
          fact.apply(facts);
          facts.request = line.request;
        });
        const State to = line.to[static_cast<unsigned>(from)];
        EXPECT_EQ(nameOf(output.state), nameOf(to));
        EXPECT_EQ(output.state, reached.machine.state());
        EXPECT_FALSE(output.reason.empty());
        EXPECT_EQ(output.reset_history, to != State::kServo);
        EXPECT_EQ(output.speed_scale, to == State::kServo ? 1.0 : 0.0);
        EXPECT_EQ(output.insertion_allowed, to == State::kServo);
        const bool by_fact = to != from && (to == State::kHold || to == State::kFault || to == State::kArmed);
        EXPECT_TRUE(!by_fact || output.reason.find(fact.words) != std::string::npos) << output.reason;
      }
    }
  }
}

// What makes the conditions of the table hold, one by one.
std::map<Condition, Fact> conditions() {
  std::map<Condition, Fact> all{
      {Condition::kClockJump, {"", [](SafetyFacts& f) { f.clock_jump = "ROS time jumped"; }, "ROS time"}},
      {Condition::kCommandNotFinite, {"", [](SafetyFacts& f) { f.command_finite = false; }, "velocity is not finite"}},
      {Condition::kResidualStop, {"", [](SafetyFacts& f) { f.residual = ResidualLevel::kStop; }, "do not agree"}},
      {Condition::kShaftOffInsertionPoint, {"", [](SafetyFacts& f) { f.pose.lateral_offset = 0.1; }, "shaft"}},
      {Condition::kDisengaged, {"", [](SafetyFacts& f) { f.request = EngageRequest::kOff; }, "not engaged"}},
      {Condition::kHeldTooLong, {"", [](SafetyFacts& f) { f.time += 0.6; }, "held for 0.5 s: the robot is paused"}},
      {Condition::kRegionChanged, {"", [](SafetyFacts& f) { f.tracker.region = 2.0; }, "another region"}},
      {Condition::kRobotSilent, {"", [](SafetyFacts& f) { f.robot.age = 9.0; }, "operating state"}},
      {Condition::kEnded, {"", [](SafetyFacts& f) { f.ended = "the robot said FAULT"; }, "said FAULT"}},
      {Condition::kRobotStopped, {"", [](SafetyFacts& f) { ++f.robot.enables; }, "stopped, and enabled again"}},
      {Condition::kRobotPaused, {"", [](SafetyFacts& f) { f.robot.enabled = false, f.robot.paused = true; }, "paused"}},
      {Condition::kPoseUnknown, {"", [](SafetyFacts& f) { f.pose.problem = "atlantis"; }, "atlantis"}},
      {Condition::kPoseOld, {"", [](SafetyFacts& f) { f.pose.age = 9.0; }, "depth d2 is older"}},
      {Condition::kDepthOutOfRange, {"", [](SafetyFacts& f) { f.pose.d2 = 0.5; }, "depth d2 is not between"}},
      {Condition::kTrackerUnusable, {"", [](SafetyFacts& f) { f.tracker.problem = "future"; }, "future"}},
      {Condition::kTrackerSilent, {"", [](SafetyFacts& f) { f.tracker.age = 9.0; }, "silent"}},
      {Condition::kImageOld, {"", [](SafetyFacts& f) { f.tracker.image_age = 9.0; }, "image behind"}},
      {Condition::kTrackerInvalid, {"", [](SafetyFacts& f) { f.tracker.valid = false; }, "not valid"}},
      {Condition::kEffectDoubted,
       {"",
        [](SafetyFacts& f) {
          f.effect = {Effect::kDoubted, "the picture moves as if"};
        },
        "the picture moves as if"}},
      {Condition::kWandered,
       {"", [](SafetyFacts& f) { f.wandered = "the view has wandered"; }, "the view has wandered"}},
      {Condition::kEffectWrong,
       {"",
        [](SafetyFacts& f) {
          f.effect = {Effect::kWrong, "the picture moves as if"};
        },
        "the picture moves as if"}},
      {Condition::kOccluded, {"", [](SafetyFacts& f) { f.tracker.visible_fraction = 0.1; }, "occluded"}},
      {Condition::kEngaged, {"", [](SafetyFacts& f) { f.request = EngageRequest::kOn; }, "nothing is missing"}},
      {Condition::kDeadManReleased, {"", [](SafetyFacts& f) { f.dead_man.pressed = false; }, "dead-man"}},
      {Condition::kNothingMissing, {"", [](SafetyFacts&) {}, "nothing is missing"}},
  };
  all[Condition::kEngagedReleased] = {"",
                                      [](SafetyFacts& f) {
                                        f.request = EngageRequest::kOn;
                                        f.dead_man.pressed = false;
                                      },
                                      "dead-man"};
  return all;
}

TEST(SafetyMachine, EachRowOfTheTableIsTaken) {
  std::set<Condition> seen;
  for (const SafetyTransition& row : safetyTransitions()) {
    const Fact fact = conditions().at(row.condition);
    EXPECT_TRUE(seen.insert(row.condition).second) << "one row for each condition";
    EXPECT_STRNE(row.way_on, "");
    for (const State from : kSafetyStates) {
      if (!row.contains(from)) continue;
      Reached reached(from);
      const SafetyOutput output = reached.step(fact.apply);
      EXPECT_EQ(nameOf(output.state), nameOf(row.to)) << fact.words << " in " << nameOf(from);
      EXPECT_NE(output.reason.find(fact.words), std::string::npos) << output.reason;
      const bool needs_somebody = row.to == State::kFault || row.to == State::kLost;
      EXPECT_EQ(output.reason.find("engage again") != std::string::npos, needs_somebody) << output.reason;
    }
  }
  EXPECT_EQ(seen.size(), conditions().size());
}

// Of two conditions that hold at once, the one that stands first in the table decides.
TEST(SafetyMachine, TheMoreSevereConditionDecides) {
  const std::vector<SafetyTransition>& table = safetyTransitions();
  int pairs = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (std::size_t j = i + 1; j < table.size(); ++j) {
      // A pose that cannot be used says nothing about the shaft.
      const bool depends = table[i].condition == Condition::kShaftOffInsertionPoint &&
                           (table[j].condition == Condition::kPoseUnknown || table[j].condition == Condition::kPoseOld);
      // One request at a time.
      const bool requests =
          table[i].condition == Condition::kDisengaged && (table[j].from & table[i].from) != 0 &&
          (table[j].condition == Condition::kEngaged || table[j].condition == Condition::kEngagedReleased);
      if (depends || requests) continue;
      const Fact first = conditions().at(table[i].condition);
      const Fact second = conditions().at(table[j].condition);
      for (const State from : kSafetyStates) {
        if (!table[i].contains(from) || !table[j].contains(from)) continue;
        Reached reached(from);
        const SafetyOutput output = reached.step([&](SafetyFacts& facts) {
          second.apply(facts);
          first.apply(facts);
        });
        EXPECT_EQ(nameOf(output.state), nameOf(table[i].to)) << first.words << " and " << second.words;
        EXPECT_NE(output.reason.find(first.words), std::string::npos) << output.reason << ", not " << second.words;
        ++pairs;
      }
    }
  }
  EXPECT_GT(pairs, 200);
}

TEST(SafetyMachine, FaultsStandBeforeStopsBeforeHoldsBeforeTheRest) {
  const auto rank = [](State to) {
    return to == State::kFault ? 0 : to == State::kLost ? 1 : to == State::kHold ? 2 : 3;
  };
  int last = 0;
  for (const SafetyTransition& row : safetyTransitions()) {
    if (!row.contains(State::kServo) || row.to == State::kIdle) continue;
    EXPECT_GE(rank(row.to), last);
    last = rank(row.to);
  }
}

// What SERVO needs, in words of its own.
bool mayMove(const SafetyFacts& f) {
  const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
  return f.clock_jump.empty() && f.command_finite && f.residual != ResidualLevel::kStop && f.robot.problem.empty() &&
         f.robot.enabled && within(f.robot.age, 0.0, 0.5) && f.pose.problem.empty() && within(f.pose.age, 0.0, 0.25) &&
         within(f.pose.d2, 0.02, 0.25) && within(f.pose.lateral_offset, 0.0, 0.015) && f.tracker.problem.empty() &&
         within(f.tracker.age, 0.0, 0.25) && within(f.tracker.image_age, 0.0, 0.25) && f.tracker.valid &&
         f.tracker.visible_fraction >= 0.2 && f.dead_man.pressed && within(f.dead_man.age, 0.0, 0.2) &&
         f.wandered.empty() && f.request != EngageRequest::kOff;
}

TEST(SafetyMachine, WhateverComesItMovesOnlyWhenItMay) {
  Chance chance(7);
  SafetyMachine machine(strict());
  State before = State::kIdle;
  double time = 0.0;
  double hold_since = 0.0;
  std::set<std::pair<State, State>> changes;
  int moved = 0;
  for (int k = 0; k < 200000; ++k) {
    time += 0.04 * chance.uniform();
    const SafetyFacts facts = chance.next(time);
    const bool was_engaged = isEngaged(before);
    const SafetyOutput output = machine.step(facts);
    const State now = output.state;
    SCOPED_TRACE(nameOf(before) + " to " + nameOf(now) + ": " + output.reason);
    ASSERT_FALSE(output.reason.empty());
    ASSERT_EQ(output.reset_history, now != State::kServo);
    if (now == State::kServo) {
      ASSERT_TRUE(mayMove(facts));
      ASSERT_TRUE(output.speed_scale >= 0.0 && output.speed_scale <= 1.0);
      ++moved;
    } else {
      ASSERT_EQ(output.speed_scale, 0.0);
      ASSERT_FALSE(output.insertion_allowed);
    }
    if (chance.fault && was_engaged) {
      ASSERT_EQ(now, State::kFault);
    }
    if (now != before) {
      changes.insert({before, now});
      if (before == State::kIdle || before == State::kLost) {
        ASSERT_NE(facts.request, EngageRequest::kNone);
      }
      if (before == State::kFault) {
        ASSERT_EQ(facts.request, EngageRequest::kOff);
        ASSERT_EQ(now, State::kIdle);
      }
      if (now == State::kHold) hold_since = time;
    }
    if (before == State::kHold && time - hold_since >= 0.5) {
      ASSERT_TRUE(now == State::kLost || now == State::kFault || now == State::kIdle);
    }
    before = now;
  }
  EXPECT_GT(moved, 10000);
  // All that the table allows came about, and nothing else.
  std::set<std::pair<State, State>> allowed;
  for (const SafetyTransition& row : safetyTransitions()) {
    for (const State from : kSafetyStates) {
      if (row.contains(from) && row.to != from) allowed.insert({from, row.to});
    }
  }
  EXPECT_EQ(changes, allowed);
}

}  // namespace
}  // namespace laparoscope_servo::servo
