// The services of the aesop node. Each answers when the arm has confirmed the request, or after a timeout.
#include <ros/ros.h>

#include "ros/aesop/aesop_node.h"
#include "ros/common/clocks.h"

namespace laparoscope_servo {

using aesop::OperatingMode;
using Response = std_srvs::Trigger::Response;

namespace {

Response answer(const std::string& refusal) {
  Response response;
  response.success = refusal.empty();
  response.message = refusal;
  return response;
}

}  // namespace

void AesopNode::advertise(const std::string& name, Action action, Callers callers) {
  using Event = ros::ServiceEvent<std_srvs::Trigger::Request, Response>;
  const boost::function<bool(Event&)> serve = [=](Event& event) {
    const std::string caller = event.getCallerName();
    Response& response = event.getResponse();
    const std::string refusal = callers == Callers::kNamed ? callers_.refusal(name, caller) : "";
    service_errors_.guard(response, [&] { response = refusal.empty() ? (this->*action)() : answer(refusal); });
    ROS_INFO_STREAM(name << ", called by " << shownName(caller) << ": " << (response.success ? "done" : "refused")
                         << (response.message.empty() ? "" : ", ") << response.message);
    return true;
  };
  services_.push_back(private_node_.advertiseService(name, serve));
}

Response AesopNode::enable() {
  const std::string obstacle = stops_.obstacle(steadyNow());
  if (!obstacle.empty()) return answer(obstacle);
  if (calibration_.waits()) return answer("a new insertion point waits until the arm stands; try again");
  Response response = answer(driver_.enable(stampNow(), steadyNow()));
  if (!response.success) return response;
  const auto settled = [this] {
    return driver_.session().isEnabled() || !driver_.session().link().isUp() || !driver_.state(steadyNow()).is_busy;
  };
  stepUntil(settled, parameters_.driver.session.request_timeout + 0.1);
  response.success = driver_.session().isEnabled();
  response.message = response.success ? "enabled" : driver_.state(steadyNow()).reason;
  return response;
}

Response AesopNode::disable() {
  Response response = answer(driver_.disable(steadyNow()));
  if (!response.success) return response;
  const auto settled = [this] { return !driver_.state(steadyNow()).is_busy; };
  response.success = stepUntil(settled, parameters_.driver.session.request_timeout) && driver_.session().link().isUp();
  response.message =
      response.success ? "disabled, the arm stands" : "the controller has not confirmed that the arm stands";
  return response;
}

Response AesopNode::clearFault() {
  Response response = answer(driver_.clearFault(steadyNow()));
  if (!response.success) return response;
  const auto settled = [this] { return !driver_.state(steadyNow()).is_busy; };
  stepUntil(settled, parameters_.driver.session.request_timeout + 0.1);
  const aesop::OperatingState state = driver_.state(steadyNow());
  response.success = state.mode == OperatingMode::kDisabled && driver_.session().link().isUp();
  response.message = state.reason;
  return response;
}

Response AesopNode::pause() {
  return answer(driver_.pause());
}

Response AesopNode::resume() {
  const std::string obstacle = stops_.obstacle(steadyNow());
  return answer(obstacle.empty() ? driver_.resume(stampNow()) : obstacle);
}

}  // namespace laparoscope_servo
