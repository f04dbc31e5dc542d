#include "screen/stop_report.h"

namespace laparoscope_servo::screen {

StopReport::Presence StopReport::presenceOf(bool connected, bool heard) {
  return connected ? Presence::kThere : heard ? Presence::kEnded : Presence::kUnseen;
}

StopReport::StopReport(const Facts& facts) : connected_(true) {
  controller_.presence = presenceOf(facts.controller.connected, facts.controller.heard_at >= 0.0);
  arm_.presence = presenceOf(facts.robot.connected, facts.robot.heard_at >= 0.0);
}

void StopReport::answered(Node node, const Answer& answer) {
  (node == Node::kArm ? arm_ : controller_).answer = answer;
}

// A node that the screen has not seen may answer all the same.
bool StopReport::Part::absent() const {
  return presence == Presence::kUnseen && answer.outcome == Outcome::kUnanswered;
}

std::string StopReport::Part::words(const std::string& who, const std::string& done) const {
  if (answer.outcome == Outcome::kWaiting) return "The " + who + " has not answered yet.";
  if (answer.outcome == Outcome::kDone) return "The " + who + " is " + done + ".";
  if (absent()) return "There is no " + who + ".";
  const bool ended = presence == Presence::kEnded && answer.outcome == Outcome::kUnanswered;
  return "The " + who + (ended ? "'s node has ended." : " has not confirmed it.");
}

Answer StopReport::answer() const {
  Answer whole{"STOP", "", Outcome::kUnanswered};
  if (!connected_) {
    whole.text = "There is no ROS master: nobody could be told. If an arm moves, use its own stop.";
    return whole;
  }
  const bool waits = arm_.answer.outcome == Outcome::kWaiting || controller_.answer.outcome == Outcome::kWaiting;
  const auto settled = [](const Part& part) { return part.absent() || part.answer.outcome == Outcome::kDone; };
  if (waits || (settled(arm_) && settled(controller_))) whole.outcome = waits ? Outcome::kWaiting : Outcome::kDone;
  if (arm_.absent() && controller_.absent()) {
    whole.text = "There is no arm and no controller here: nothing had to be stopped.";
    return whole;
  }
  whole.text = arm_.words("arm", "disabled");
  if (!waits && !settled(arm_)) whole.text += " If the arm moves, use its own stop.";
  whole.text += " " + controller_.words("controller", "disengaged");
  for (const Part* part : {&arm_, &controller_}) {
    if (!settled(*part) && !part->answer.text.empty()) whole.text += " " + part->answer.text;
  }
  return whole;
}

}  // namespace laparoscope_servo::screen
