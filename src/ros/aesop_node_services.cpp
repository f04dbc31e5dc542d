// The services of the aesop node. Each answers when the arm has confirmed what was asked for, or when it has not in
// time.
#include <ros/ros.h>

#include "laparoscope_servo/ros/aesop_node.h"
#include "laparoscope_servo/ros/clocks.h"

namespace laparoscope_servo::skin {

using aesop::OperatingMode;

bool AesopNode::enable(Request&, Response& response) {
  response.message = driver_.enable(stampNow(), steadyNow());
  if (!response.message.empty()) return true;
  const auto settled = [this] {
    return driver_.session().isEnabled() || !driver_.session().link().isUp() || !driver_.state(steadyNow()).is_busy;
  };
  stepUntil(settled, parameters_.driver.session.request_timeout + 0.1);
  response.success = driver_.session().isEnabled();
  response.message = response.success ? "enabled" : driver_.state(steadyNow()).reason;
  return true;
}

bool AesopNode::disable(Request&, Response& response) {
  response.message = driver_.disable(steadyNow());
  if (!response.message.empty()) return true;
  const auto settled = [this] { return !driver_.state(steadyNow()).is_busy; };
  response.success = stepUntil(settled, parameters_.driver.session.request_timeout) && driver_.session().link().isUp();
  response.message =
      response.success ? "disabled, the arm stands" : "the controller has not confirmed that the arm stands";
  return true;
}

bool AesopNode::clearFault(Request&, Response& response) {
  response.message = driver_.clearFault(steadyNow());
  if (!response.message.empty()) return true;
  const auto settled = [this] { return !driver_.state(steadyNow()).is_busy; };
  stepUntil(settled, parameters_.driver.session.request_timeout + 0.1);
  const aesop::OperatingState state = driver_.state(steadyNow());
  response.success = state.mode == OperatingMode::kDisabled && driver_.session().link().isUp();
  response.message = state.reason;
  return true;
}

bool AesopNode::pause(Request&, Response& response) {
  response.message = driver_.pause();
  response.success = response.message.empty();
  return true;
}

bool AesopNode::resume(Request&, Response& response) {
  response.message = driver_.resume(stampNow());
  response.success = response.message.empty();
  return true;
}

}  // namespace laparoscope_servo::skin
