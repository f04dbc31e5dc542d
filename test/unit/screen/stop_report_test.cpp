#include "screen/stop_report.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::screen {
namespace {

using Node = StopReport::Node;

Answer answer(Outcome outcome, const std::string& text = "") {
  return {"STOP", text, outcome};
}

Facts cart() {
  Facts facts;
  facts.master = true;
  facts.controller.connected = facts.robot.connected = true;
  facts.controller.heard_at = facts.robot.heard_at = 7.0;
  return facts;
}

Answer after(const Facts& facts, const Answer& controller, const Answer& arm) {
  StopReport report(facts);
  report.answered(Node::kController, controller);
  report.answered(Node::kArm, arm);
  return report.answer();
}

TEST(StopReport, IsDoneWhenBothHaveConfirmed) {
  StopReport report(cart());
  EXPECT_EQ(report.answer().outcome, Outcome::kWaiting);
  report.answered(Node::kArm, answer(Outcome::kDone));
  EXPECT_EQ(report.answer().outcome, Outcome::kWaiting) << "the controller hangs";
  EXPECT_EQ(report.answer().text, "The arm is disabled. The controller has not answered yet.");
  report.answered(Node::kController, answer(Outcome::kDone));
  EXPECT_EQ(report.answer().outcome, Outcome::kDone);
  EXPECT_EQ(report.answer().text, "The arm is disabled. The controller is disengaged.");
}

TEST(StopReport, WithoutAnArmNothingWasRefused) {
  const Answer nobody = answer(Outcome::kUnanswered, "No node offers /aesop/disable: it is not running.");
  Facts facts;
  facts.master = true;
  EXPECT_EQ(after(facts, nobody, nobody).outcome, Outcome::kDone);
  EXPECT_EQ(after(facts, nobody, nobody).text, "There is no arm and no controller here: nothing had to be stopped.");
  facts.controller = cart().controller;
  EXPECT_EQ(after(facts, answer(Outcome::kDone), nobody).text, "There is no arm. The controller is disengaged.");
  EXPECT_EQ(after(facts, answer(Outcome::kDone), nobody).outcome, Outcome::kDone);
}

TEST(StopReport, AnArmThatDoesNotConfirmIsNeverDone) {
  const Answer done = answer(Outcome::kDone);
  for (const Outcome outcome : {Outcome::kRefused, Outcome::kUnanswered}) {
    const Answer whole = after(cart(), done, answer(outcome, "No answer came from /aesop/disable."));
    EXPECT_EQ(whole.outcome, Outcome::kUnanswered);
    EXPECT_EQ(
        whole.text,
        "The arm has not confirmed it. If the arm moves, use its own stop. The controller is disengaged. No answer "
        "came from /aesop/disable.");
  }
  Facts ended = cart();
  ended.robot.connected = false;
  const Answer whole = after(ended, done, answer(Outcome::kUnanswered));
  EXPECT_EQ(whole.outcome, Outcome::kUnanswered) << "it was there, and may still move";
  EXPECT_EQ(whole.text.find("The arm's node has ended. If the arm moves, use its own stop."), 0u) << whole.text;
}

TEST(StopReport, ANodeThatTheScreenHasNotSeenYetIsAskedAllTheSame) {
  Facts facts;
  facts.master = true;
  const Answer nobody = answer(Outcome::kUnanswered);
  EXPECT_EQ(after(facts, nobody, answer(Outcome::kDone)).text, "The arm is disabled. There is no controller.");
  EXPECT_EQ(after(facts, nobody, answer(Outcome::kRefused, "it says no")).outcome, Outcome::kUnanswered);
}

TEST(StopReport, WithoutAMasterNobodyCouldBeTold) {
  EXPECT_EQ(StopReport().answer().outcome, Outcome::kUnanswered);
  EXPECT_NE(StopReport().answer().text.find("no ROS master"), std::string::npos);
}

}  // namespace
}  // namespace laparoscope_servo::screen
