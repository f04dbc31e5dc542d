// What the screen asks of the nodes: RosLink's calls of services, and STOP.
#include <laparoscope_servo/ControlPlayback.h>
#include <laparoscope_servo/SelectFeatures.h>
#include <laparoscope_servo/SelectTask.h>
#include <std_msgs/Empty.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include "screen/ros_link.h"
#include "screen/task_words.h"

namespace laparoscope_servo::screen {

void RosLink::stop() {
  dead_man_.letGo();
  slider_.letGo();
  for (Wish* wish : {&enabled_, &resumed_, &engaged_, &stopped_}) wish->end();
  tracker_.thaw();
  bool connected = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (connection_) {
      connection_->robot_stop.publish(std_msgs::Empty());
      connection_->controller_stop.publish(std_msgs::Empty());
      connection_->sender->wake();
      connected = true;
    }
  }
  {
    const std::lock_guard<std::mutex> lock(stop_mutex_);
    stop_report_ = connected ? StopReport(keeper_.facts()) : StopReport();
  }
  if (!connected) return take(StopReport().answer());
  // Without a lock, which those who are told take.
  setEngaged(false, "STOP", reportOf(StopReport::Node::kController));
  trigger("aesop/disable", "STOP", reportOf(StopReport::Node::kArm));
}

ServiceCalls::Manner RosLink::reportOf(StopReport::Node node) {
  ServiceCalls::Manner manner;
  manner.wanted = stopped_.present();
  manner.told = [this, node](const Answer& answer) {
    Answer whole;
    {
      const std::lock_guard<std::mutex> lock(stop_mutex_);
      stop_report_.answered(node, answer);
      whole = stop_report_.answer();
    }
    take(whole);
  };
  return manner;
}

void RosLink::trigger(const std::string& service, const std::string& what, const ServiceCalls::Manner& manner) {
  const std::string name = resolved(service);
  if (!name.empty()) calls_.call(name, what, std_srvs::Trigger(), manner);
}

void RosLink::enable() {
  ServiceCalls::Manner manner;
  manner.wanted = enabled_.present();
  manner.late = [this] { trigger("aesop/disable", "Disable, since Enable came late"); };
  trigger("aesop/enable", "Enable", manner);
}

void RosLink::disable() {
  enabled_.end();
  resumed_.end();
  trigger("aesop/disable", "Disable");
}

void RosLink::pause() {
  resumed_.end();
  trigger("aesop/pause", "Hold");
}

void RosLink::resume() {
  ServiceCalls::Manner manner;
  manner.wanted = resumed_.present();
  manner.late = [this] { trigger("aesop/pause", "Hold, since Resume came late"); };
  trigger("aesop/resume", "Resume", manner);
}

void RosLink::engage(bool on) {
  if (!on) {
    engaged_.end();
    return setEngaged(false, "Disengage", {});
  }
  ServiceCalls::Manner manner;
  manner.wanted = engaged_.present();
  manner.late = [this] { setEngaged(false, "Disengage, since Engage came late", {}); };
  setEngaged(true, "Engage", manner);
}

// To disengage does not wait for an answer to what engages.
void RosLink::setEngaged(bool on, const std::string& what, const ServiceCalls::Manner& manner) {
  std_srvs::SetBool request;
  request.request.data = static_cast<std::uint8_t>(on);
  const std::string name = resolved("controller/engage");
  ServiceCalls::Manner in_line = manner;
  in_line.line = name + (on ? " true" : " false");
  if (!name.empty()) calls_.call(name, what, request, in_line);
}

void RosLink::selectTask(const std::string& task) {
  SelectTask request;
  request.request.task = task;
  const std::string name = resolved("controller/select_task");
  if (!name.empty()) calls_.call(name, "Task " + nameOfTask(task), request);
}

void RosLink::keepView() {
  SelectFeatures request;
  request.request.selection = "[{id: view, motion: []}]";
  const std::string name = resolved("motion/select_features");
  if (!name.empty()) calls_.call(name, "Keep this view", request);
}

void RosLink::controlPlayback(const std::string& command, double position) {
  ControlPlayback request;
  request.request.command = command;
  request.request.position = position;
  const std::string name = resolved("player/control");
  if (!name.empty()) calls_.call(name, "Recording: " + command, request);
}

}  // namespace laparoscope_servo::screen
