// The services of the controller. Each runs a step of the control at once, so that its answer is the new state.
#include "ros/common/clocks.h"
#include "ros/controller/controller_conversions.h"
#include "ros/controller/controller_node.h"

namespace laparoscope_servo {

bool ControllerNode::onEngage(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  service_errors_.guard(response, [&] { engage(request.data, response); });
  return true;
}

bool ControllerNode::onSelectTask(SelectTask::Request& request, SelectTask::Response& response) {
  service_errors_.guard(response, [&] { selectTask(request.task, response); });
  return true;
}

void ControllerNode::engage(bool on, std_srvs::SetBool::Response& response) {
  checkTime();
  if (!on) {
    controller_.disengage("not engaged");
    response.success = true;
    response.message = "disengaged";
  } else if (controller_.engaged()) {
    response.success = true;
    response.message = "was engaged already, " + toMessage(last_output_).state + ": " + last_output_.reason;
  } else {
    inputs_.engaging();
    std::string problem = stops_.obstacle(steadyNow());
    if (problem.empty()) problem = controller_.engage(input());
    response.success = problem.empty();
    response.message = problem.empty() ? "engaged" : kNotEngaged + problem;
  }
  onTick();
}

void ControllerNode::selectTask(const std::string& task, SelectTask::Response& response) {
  checkTime();
  const std::optional<servo::Task> known = taskNamed(task);
  response.success = known.has_value();
  if (!known) {
    response.message =
        "no task '" + task + "', expected " + taskNames() + "; " + taskName(controller_.task()) + " goes on";
    return;
  }
  controller_.select(*known);
  onTick();
  response.message = task + ", " + toMessage(last_output_).state + ": " + last_output_.reason;
}

}  // namespace laparoscope_servo
