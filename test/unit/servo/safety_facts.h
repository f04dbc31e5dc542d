// What the safety states are told, good and bad, for their tests.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "servo/safety/safety_machine.h"

namespace laparoscope_servo::servo::test {

using State = SafetyState;

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kStep = 0.02;  // s

// All that can be asked for is asked for.
inline SafetyConfig strict() {
  SafetyConfig config;
  config.dead_man_required = true;
  config.robot_required = true;
  config.resume_time = 0.5;
  return config;
}

// Nothing is missing, the dead-man switch is pressed.
inline SafetyFacts good(double time) {
  SafetyFacts facts;
  facts.time = time;
  facts.robot = {"", true, 0.1, false, 7};
  facts.pose = {"", 0.02, 0.1, 0.001};
  facts.tracker = {"", 0.02, 0.06, true, 1.0, 1.0, 0.1};
  facts.dead_man = {true, 0.01, ""};
  return facts;
}

using Change = std::function<void(SafetyFacts&)>;

struct Fact {
  std::string name;
  Change apply;
  std::string words = {};  // in the reason
};

inline std::vector<Fact> faults() {
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

inline std::vector<Fact> holds() {
  std::vector<Fact> all{
      {"no robot", [](SafetyFacts& f) { f.robot = RobotFacts(); }, "no operating state"},
      {"robot paused", [](SafetyFacts& f) { f.robot.enabled = false, f.robot.paused = true; }, "robot is paused"},
      {"no pose", [](SafetyFacts& f) { f.pose = PoseFacts(); }, "d2 is unknown"},
      {"tf's problem", [](SafetyFacts& f) { f.pose.problem = "tf is static"; }, "tf is static"},
      {"no task error", [](SafetyFacts& f) { f.tracker = TrackerFacts(); }, "no task error"},
      {"tracker's problem", [](SafetyFacts& f) { f.tracker.problem = "task error is not finite"; }, "not finite"},
      {"tracker lost", [](SafetyFacts& f) { f.tracker.valid = false; }, "not valid"},
      {"wandered", [](SafetyFacts& f) { f.wandered = "the view has wandered"; }, "the view has wandered"},
  };
  for (const double d2 : {0.019, 0.251, -0.1, 0.0, 1e300, kNan, kInfinity, -kInfinity}) {
    all.push_back({"d2 " + std::to_string(d2), [=](SafetyFacts& f) { f.pose.d2 = d2; }, "not between"});
  }
  all.push_back({"d2 perhaps too small", [](SafetyFacts& f) { f.pose.d2_doubt = 0.24; }, "not between"});
  all.push_back({"d2's doubt not a number", [](SafetyFacts& f) { f.pose.d2_doubt = kNan; }, "not between"});
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

// A stop that somebody made.
inline std::vector<Fact> stops() {
  return {
      {"robot not enabled", [](SafetyFacts& f) { f.robot.enabled = false; }, "not enabled"},
      {"robot disabled long ago", [](SafetyFacts& f) { f.robot.enabled = false, f.robot.age = 9.0; }, "not enabled"},
      {"ended", [](SafetyFacts& f) { f.ended = "the robot said FAULT"; }, "FAULT"}};
}

inline std::vector<Fact> releases() {
  std::vector<Fact> all{{"released", [](SafetyFacts& f) { f.dead_man.pressed = false; }, "dead-man"},
                        {"held down before",
                         [](SafetyFacts& f) {
                           f.dead_man = {false, 0.01, "release it once"};
                         },
                         "release it once"}};
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
    const Change lost = [](SafetyFacts& f) { f.robot.enabled = false, f.robot.paused = true; };
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

inline std::string nameOf(State state) {
  return servo::name(state);
}

// Facts at random, mostly good; some stay bad for a while.
class Chance {
 public:
  explicit Chance(unsigned seed) : random_(seed) {
    lasting_ = holds();
    for (int k = 0; k < 4; ++k) {  // as likely as the many holds
      for (const Fact& fact : releases()) lasting_.push_back(fact);
      for (const Fact& fact : stops()) lasting_.push_back(fact);
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

}  // namespace laparoscope_servo::servo::test
