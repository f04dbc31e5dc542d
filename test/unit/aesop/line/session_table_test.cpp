#include "laparoscope_servo/aesop/session_table.h"

#include <gtest/gtest.h>

#include <functional>
#include <iterator>
#include <map>
#include <string>

#include "unit/aesop/session_fixture.h"

namespace laparoscope_servo::aesop {
namespace {

using State = SessionState;
using Event = SessionEvent;

std::vector<Event> events() {
  std::vector<Event> all;
  for (unsigned k = 0; k < kSessionEvents; ++k) all.push_back(static_cast<Event>(k));
  return all;
}

// Where each event leads from DISABLED, Enabling, ENABLED, PAUSED and Clearing: the initials of these.
const std::map<Event, std::string>& expected() {
  static const std::map<Event, std::string> map{
      {Event::kEnable, "EENPC"},         {Event::kDisable, "DDDDD"},
      {Event::kStop, "DDDDD"},           {Event::kClearFault, "CENPC"},
      {Event::kPause, "DEPPC"},          {Event::kResume, "DENNC"},
      {Event::kGiveUp, "DDDDD"},         {Event::kLinkLost, "DDDDD"},
      {Event::kFault, "DDDDC"},          {Event::kNoFault, "DENPD"},
      {Event::kNotHomed, "DDDDC"},       {Event::kEnableConfirmed, "DNNPC"},
      {Event::kDisabledItself, "DEDDC"}, {Event::kDisableConfirmed, "DENPC"},
      {Event::kEnableOverdue, "DDNPC"},  {Event::kClearOverdue, "DENPD"},
      {Event::kDisableOverdue, "DENPC"},
  };
  return map;
}

State stateOfInitial(char initial) {
  return kSessionStates[std::string("DENPC").find(initial)];
}

State after(State state, Event event) {
  const SessionTransition* transition = sessionTransition(state, event);
  return transition != nullptr ? transition->to : state;
}

TEST(SessionTable, eachStateKnowsWhatEachEventDoes) {
  ASSERT_EQ(expected().size(), kSessionEvents);
  for (const Event event : events()) {
    for (std::size_t k = 0; k < std::size(kSessionStates); ++k) {
      EXPECT_EQ(after(kSessionStates[k], event), stateOfInitial(expected().at(event)[k]))
          << "event " << static_cast<unsigned>(event) << " in state " << k;
      int rows = 0;
      for (const SessionTransition& row : sessionTransitions()) {
        rows += row.event == event && row.contains(kSessionStates[k]) ? 1 : 0;
      }
      EXPECT_LE(rows, 1) << "one result";
    }
  }
}

TEST(SessionTable, onlyAConfirmedEnableLeadsToEnabled) {
  for (const SessionTransition& row : sessionTransitions()) {
    for (const State from : kSessionStates) {
      if (!row.contains(from) || isOn(from) || !isOn(row.to)) continue;
      EXPECT_EQ(row.event, Event::kEnable);
      EXPECT_EQ(from, State::kDisabled);
      EXPECT_EQ(row.to, State::kEnabling);
    }
    if (row.contains(State::kEnabling) && row.to != State::kEnabling && isOn(row.to)) {
      EXPECT_EQ(row.event, Event::kEnableConfirmed);
    }
  }
}

TEST(SessionTable, whateverEndsAnEnableDisables) {
  for (const SessionTransition& row : sessionTransitions()) {
    for (const State from : kSessionStates) {
      if (!row.contains(from)) continue;
      const bool ends = isOn(from) && !isOn(row.to);
      const bool asked = row.event == Event::kDisable || row.event == Event::kStop;
      EXPECT_EQ(row.disables, ends || asked);
      if (ends && row.event != Event::kDisable) {
        EXPECT_EQ(row.end, SessionEnd::kStopped);
      }
    }
  }
}

// From each state that is on, by each way that ends it: a Disable is what the wire carries next, and until the
// controller stands, and no velocity after it.
class EndTest : public SessionTest {
 protected:
  using End = std::function<void()>;

  void reach(State state) {
    controller_.status = FakeController().status;
    controller_.status.echo = session_.link().sequence();
    session_.closed("a test");
    connect();
    if (state == State::kEnabling) {
      ASSERT_EQ(session_.enable(now_), "");
      ASSERT_TRUE(sends<Enable>(kMove));
      return;
    }
    enable();
    ASSERT_TRUE(sends<Velocity>(kMove));
    if (state == State::kPaused) {
      ASSERT_EQ(session_.pause(), "");
    }
  }
  void say() {
    const Bytes reply = controller_.say();
    session_.receive(reply.data(), reply.size(), now_);
  }
  std::map<std::string, End> ends() {
    return {{"disable", [this] { session_.disable(now_); }},
            {"stop", [this] { session_.stop(now_, "a test"); }},
            {"give up", [this] { session_.giveUp("a test"); }},
            {"fault",
             [this] {
               controller_.status.faults = kFaultMotor;
               say();
             }},
            {"homing", [this] {
               controller_.status.homed = false;
               say();
             }}};
  }
};

TEST_F(EndTest, leadsToADisableOnTheWire) {
  for (const State state : {State::kEnabling, State::kEnabled, State::kPaused}) {
    for (const auto& [name, end] : ends()) {
      SCOPED_TRACE(name + " in " + std::to_string(static_cast<unsigned>(state)));
      reach(state);
      controller_.status.moving = true;
      controller_.status.state = RobotState::kEnabled;
      end();
      EXPECT_FALSE(session_.isEnabled());
      for (int k = 0; k < 5; ++k) EXPECT_TRUE(sends<Disable>(kMove));
      controller_.status.moving = false;
      controller_.status.state = RobotState::kDisabled;
      EXPECT_TRUE(sends<Disable>(kMove));
      for (int k = 0; k < 5; ++k) EXPECT_TRUE(sends<Poll>(kMove));
      EXPECT_FALSE(session_.isEnabled());
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo::aesop
