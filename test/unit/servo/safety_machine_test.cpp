#include "laparoscope_servo/servo/safety_machine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <utility>

namespace laparoscope_servo::servo {
namespace {

using State = SafetyState;
using Condition = SafetyCondition;

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kStep = 0.02;  // s

// All that can be asked for is asked for.
SafetyConfig strict() {
  SafetyConfig config;
  config.dead_man_required = true;
  config.robot_required = true;
  config.resume_time = 0.5;
  return config;
}

// Nothing is missing, the dead-man switch is pressed.
SafetyFacts good(double time) {
  SafetyFacts facts;
  facts.time = time;
  facts.robot = {"", true, 0.1};
  facts.pose = {"", 0.02, 0.1, 0.001};
  facts.tracker = {"", 0.02, 0.06, true, 1.0, 0.1};
  facts.dead_man = {true, 0.01};
  return facts;
}

using Change = std::function<void(SafetyFacts&)>;

struct Fact {
  std::string name;
  Change apply;
  std::string words = {};  // in the reason
};

std::vector<Fact> faults() {
  std::vector<Fact> all{
      {"clock jump", [](SafetyFacts& f) { f.clock_jump = "ROS time jumped back"; }, "ROS time"},
      {"command not finite", [](SafetyFacts& f) { f.command_finite = false; }, "not finite"},
      {"residual", [](SafetyFacts& f) { f.residual = ResidualLevel::kStop; }, "one insertion point"},
  };
  for (const double time : {-1.0, kNan, kInfinity, -kInfinity, 1e9}) {
    all.push_back({"time " + std::to_string(time), [=](SafetyFacts& f) { f.time = time; }, "steady clock"});
  }
  for (const double offset : {0.016, -0.001, kNan, kInfinity}) {
    all.push_back({"offset " + std::to_string(offset), [=](SafetyFacts& f) { f.pose.lateral_offset = offset; },
                   "passes the insertion point"});
  }
  return all;
}

std::vector<Fact> holds() {
  std::vector<Fact> all{
      {"no robot", [](SafetyFacts& f) { f.robot = RobotFacts(); }, "no operating state"},
      {"robot not enabled", [](SafetyFacts& f) { f.robot.enabled = false; }, "not enabled"},
      {"no pose", [](SafetyFacts& f) { f.pose = PoseFacts(); }, "d2 is unknown"},
      {"tf's problem", [](SafetyFacts& f) { f.pose.problem = "tf is static"; }, "tf is static"},
      {"no task error", [](SafetyFacts& f) { f.tracker = TrackerFacts(); }, "no task error"},
      {"tracker's problem", [](SafetyFacts& f) { f.tracker.problem = "task error is not finite"; }, "not finite"},
      {"tracker lost", [](SafetyFacts& f) { f.tracker.valid = false; }, "not valid"},
  };
  for (const double d2 : {0.019, 0.251, -0.1, 0.0, 1e300, kNan, kInfinity, -kInfinity}) {
    all.push_back({"d2 " + std::to_string(d2), [=](SafetyFacts& f) { f.pose.d2 = d2; }, "not between"});
  }
  for (const double visible : {0.1, -1.0, kNan}) {
    all.push_back({"visible " + std::to_string(visible), [=](SafetyFacts& f) { f.tracker.visible_fraction = visible; },
                   "occluded"});
  }
  for (const double age : {-0.01, 1.0, kNan, kInfinity}) {
    const std::string suffix = " of age " + std::to_string(age);
    all.push_back({"robot" + suffix, [=](SafetyFacts& f) { f.robot.age = age; }, "operating state is older"});
    all.push_back({"pose" + suffix, [=](SafetyFacts& f) { f.pose.age = age; }, "d2 is older"});
    all.push_back({"tracker" + suffix, [=](SafetyFacts& f) { f.tracker.age = age; }, "silent"});
    all.push_back({"image" + suffix, [=](SafetyFacts& f) { f.tracker.image_age = age; }, "image"});
  }
  return all;
}

std::vector<Fact> releases() {
  std::vector<Fact> all{{"released", [](SafetyFacts& f) { f.dead_man.pressed = false; }, "dead-man"}};
  for (const double age : {-0.01, 0.21, kNan, kInfinity}) {
    all.push_back(
        {"dead-man of age " + std::to_string(age), [=](SafetyFacts& f) { f.dead_man.age = age; }, "dead-man"});
  }
  return all;
}

// A machine that is in `state` after a step at time 10.
struct Reached {
  explicit Reached(State state, const SafetyConfig& config = strict()) : machine(config) {
    const auto step = [this](double t, const Change& change) {
      SafetyFacts facts = good(t);
      change(facts);
      return machine.step(facts).state;
    };
    const Change nothing = [](SafetyFacts&) {};
    const Change lost = [](SafetyFacts& f) { f.tracker.valid = false; };
    if (state == State::kIdle) step(time, nothing);
    if (state == State::kIdle) return;
    step(time - 1.0, [](SafetyFacts& f) { f.request = EngageRequest::kOn; });
    if (state == State::kLost) step(time - 0.6, lost);
    if (state == State::kServo) step(time, nothing);
    if (state == State::kArmed) step(time, [](SafetyFacts& f) { f.dead_man.pressed = false; });
    if (state == State::kHold || state == State::kLost) step(time, lost);
    if (state == State::kFault) step(time, [](SafetyFacts& f) { f.command_finite = false; });
    EXPECT_EQ(machine.state(), state);
  }

  SafetyOutput step(const Change& change) {
    SafetyFacts facts = good(time + kStep);
    change(facts);
    return machine.step(facts);
  }

  SafetyMachine machine;
  const double time = 10.0;
};

std::string name(State state) {
  static const char* const names[] = {"IDLE", "ARMED", "SERVO", "HOLD", "LOST", "FAULT"};
  return names[static_cast<unsigned>(state)];
}

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
      {faults(), none, {idle, fault, fault, fault, lost, fault}},
      {nothing, on, {servo, servo, servo, servo, servo, fault}},
      {releases(), on, {armed, armed, armed, armed, armed, fault}},
      {holds(), on, {idle, hold, hold, hold, lost, fault}},
      {faults(), on, {idle, fault, fault, fault, lost, fault}},
      {nothing, off, {idle, idle, idle, idle, idle, idle}},
      {releases(), off, {idle, idle, idle, idle, idle, idle}},
      {holds(), off, {idle, idle, idle, idle, idle, idle}},
      {faults(), off, {idle, fault, fault, fault, idle, idle}},
  };
}

TEST(SafetyMachine, EachFactLeadsFromEachStateWhereItShould) {
  for (const Line& line : behaviour()) {
    for (const Fact& fact : line.facts) {
      for (const State from : kSafetyStates) {
        SCOPED_TRACE(fact.name + " in " + name(from) + ", request " + std::to_string(static_cast<int>(line.request)));
        // Idle, a machine knows no time to compare with: a pause is no jump.
        if (fact.name == "time 1000000000.000000" && !isEngaged(from)) continue;
        if (fact.name == "time -1.000000" && !isEngaged(from)) continue;
        Reached reached(from);
        const SafetyOutput output = reached.step([&](SafetyFacts& facts) {
          fact.apply(facts);
          facts.request = line.request;
        });
        const State to = line.to[static_cast<unsigned>(from)];
        EXPECT_EQ(name(output.state), name(to));
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
      {Condition::kHeldTooLong, {"", [](SafetyFacts& f) { f.time += 0.6; }, "held for 0.5 s: task error is not valid"}},
      {Condition::kRobotSilent, {"", [](SafetyFacts& f) { f.robot.age = 9.0; }, "operating state"}},
      {Condition::kRobotNotEnabled, {"", [](SafetyFacts& f) { f.robot.enabled = false; }, "not enabled"}},
      {Condition::kPoseUnknown, {"", [](SafetyFacts& f) { f.pose.problem = "atlantis"; }, "atlantis"}},
      {Condition::kPoseOld, {"", [](SafetyFacts& f) { f.pose.age = 9.0; }, "depth d2 is older"}},
      {Condition::kDepthOutOfRange, {"", [](SafetyFacts& f) { f.pose.d2 = 0.5; }, "depth d2 is not between"}},
      {Condition::kTrackerUnusable, {"", [](SafetyFacts& f) { f.tracker.problem = "future"; }, "future"}},
      {Condition::kTrackerSilent, {"", [](SafetyFacts& f) { f.tracker.age = 9.0; }, "silent"}},
      {Condition::kImageOld, {"", [](SafetyFacts& f) { f.tracker.image_age = 9.0; }, "image behind"}},
      {Condition::kTrackerInvalid, {"", [](SafetyFacts& f) { f.tracker.valid = false; }, "not valid"}},
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
      EXPECT_EQ(name(output.state), name(row.to)) << fact.words << " in " << name(from);
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
        EXPECT_EQ(name(output.state), name(table[i].to)) << first.words << " and " << second.words;
        EXPECT_NE(output.reason.find(first.words), std::string::npos) << output.reason << ", not " << second.words;
        ++pairs;
      }
    }
  }
  EXPECT_GT(pairs, 200);
}

TEST(SafetyMachine, FaultsStandBeforeHoldsStandBeforeTheRest) {
  const auto rank = [](State to) { return to == State::kFault ? 0 : to == State::kHold ? 1 : 2; };
  int last = 0;
  for (const SafetyTransition& row : safetyTransitions()) {
    if (!row.contains(State::kServo) || row.to == State::kIdle) continue;
    EXPECT_GE(rank(row.to), last);
    last = rank(row.to);
  }
}

TEST(SafetyMachine, RefusesToEngageForTheReasonThatWouldStopIt) {
  for (const std::vector<Fact>& facts : {holds(), faults()}) {
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
  SafetyMachine machine{SafetyConfig()};
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
  facts.robot.enabled = false;  // another cause is the same hold
  EXPECT_EQ(other.machine.step(facts).state, State::kHold);
  facts.time = 10.5;
  const SafetyOutput output = other.machine.step(facts);
  EXPECT_EQ(output.state, State::kLost);
  EXPECT_NE(output.reason.find("not enabled"), std::string::npos) << output.reason;
  EXPECT_EQ(other.machine.step(good(10.6)).state, State::kLost);
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

// Facts at random, mostly good; some stay bad for a while.
class Chance {
 public:
  explicit Chance(unsigned seed) : random_(seed) {
    for (const auto& list : {holds(), releases()}) {
      for (const Fact& fact : list) lasting_.push_back(fact);
    }
  }
  bool is(double probability) { return uniform() < probability; }
  double uniform() { return static_cast<double>(random_()) / 4294967296.0; }

  SafetyFacts next(double time) {
    SafetyFacts facts = good(time);
    facts.robot.age = 0.5 * uniform();
    facts.pose.age = 0.25 * uniform();
    facts.tracker.age = 0.25 * uniform();
    facts.tracker.image_age = 0.25 * uniform();
    facts.tracker.visible_fraction = uniform() < 0.8 ? 0.2 + 0.8 * uniform() : uniform();
    facts.tracker.corner_error = 2.0 * uniform();
    facts.residual = is(0.1) ? ResidualLevel::kWarning : ResidualLevel::kOk;
    if (left_ > 0) {
      --left_;
    } else {
      bad_ = is(0.1) ? &lasting_[random_() % lasting_.size()] : nullptr;
      left_ = static_cast<int>(random_() % 40U);
    }
    if (bad_ != nullptr) bad_->apply(facts);
    fault = is(0.005);
    const std::vector<Fact> all = faults();
    if (fault) all[random_() % 3U].apply(facts);
    if (is(0.05)) facts.request = EngageRequest::kOn;
    if (is(0.02)) facts.request = EngageRequest::kOff;
    return facts;
  }

  bool fault = false;

 private:
  std::mt19937 random_;
  std::vector<Fact> lasting_;
  const Fact* bad_ = nullptr;
  int left_ = 0;
};

// What SERVO needs, in words of its own.
bool mayMove(const SafetyFacts& f) {
  const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
  return f.clock_jump.empty() && f.command_finite && f.residual != ResidualLevel::kStop && f.robot.problem.empty() &&
         f.robot.enabled && within(f.robot.age, 0.0, 0.5) && f.pose.problem.empty() && within(f.pose.age, 0.0, 0.25) &&
         within(f.pose.d2, 0.02, 0.25) && within(f.pose.lateral_offset, 0.0, 0.015) && f.tracker.problem.empty() &&
         within(f.tracker.age, 0.0, 0.25) && within(f.tracker.image_age, 0.0, 0.25) && f.tracker.valid &&
         f.tracker.visible_fraction >= 0.2 && f.dead_man.pressed && within(f.dead_man.age, 0.0, 0.2) &&
         f.request != EngageRequest::kOff;
}

TEST(SafetyMachine, WhateverComesItMovesOnlyWhenItMay) {
  Chance chance(7);
  SafetyMachine machine(strict());
  State before = State::kIdle;
  double time = 0.0;
  double hold_since = 0.0;
  std::set<std::pair<State, State>> changes;
  int moved = 0;
  for (int k = 0; k < 100000; ++k) {
    time += 0.04 * chance.uniform();
    const SafetyFacts facts = chance.next(time);
    const bool was_engaged = isEngaged(before);
    const SafetyOutput output = machine.step(facts);
    const State now = output.state;
    SCOPED_TRACE(name(before) + " to " + name(now) + ": " + output.reason);
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

TEST(SafetyMachine, TheReasonStaysWhileItsCauseDoes) {
  for (const Fact& fact : holds()) {
    Reached reached(State::kServo);
    const std::string reason = reached.step(fact.apply).reason;
    Chance chance(3);
    for (int k = 2; k < 20; ++k) {
      SafetyFacts facts = good(reached.time + kStep * k);
      facts.robot.age = 0.4 * chance.uniform();
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
