#include "ros/common/reconfigure_server.h"

#include <std_msgs/String.h>

#include <algorithm>
#include <stdexcept>

#include "laparoscope_servo/parameters/pages.h"
#include "ros/common/reconfigure_messages.h"

namespace laparoscope_servo {

namespace {

XmlRpc::XmlRpcValue toXmlRpc(const parameters::Value& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return XmlRpc::XmlRpcValue(*flag);
  if (const auto* integer = std::get_if<int>(&value)) return XmlRpc::XmlRpcValue(*integer);
  if (const auto* number = std::get_if<double>(&value)) return XmlRpc::XmlRpcValue(*number);
  return XmlRpc::XmlRpcValue(std::get<std::string>(value));
}

std::string joined(const std::vector<std::string>& errors) {
  constexpr std::size_t kMost = 20;
  std::string text;
  for (std::size_t k = 0; k < std::min(errors.size(), kMost); ++k) text += (k == 0 ? "" : "; ") + errors[k];
  return text + (errors.size() > kMost ? "; and " + std::to_string(errors.size() - kMost) + " more" : "");
}

ros::NodeHandle withQueue(ros::NodeHandle node, ros::CallbackQueue& queue) {
  node.setCallbackQueue(&queue);
  return node;
}

}  // namespace

ReconfigureServer::ReconfigureServer(const ros::NodeHandle& private_node, const parameters::Table& table,
                                     const std::function<std::vector<std::string>()>& validate,
                                     const std::function<void()>& commit)
    : table_(table),
      validate_(validate),
      commit_(commit),
      node_(withQueue(private_node, queue_)),
      descriptions_(node_.advertise<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", 1, true)),
      updates_(node_.advertise<dynamic_reconfigure::Config>("parameter_updates", 1, true)),
      refusals_(node_.advertise<std_msgs::String>("parameters_refused", 5)),
      spinner_(1, &queue_) {
  descriptions_.publish(describeForReconfigure(table_));
  updates_.publish(valuesForReconfigure(table_));
  const boost::function<bool(Event&)> set = [this](Event& event) { return onSet(event); };
  service_ = node_.advertiseService<Event>("set_parameters", set);
  spinner_.start();
}

ReconfigureServer::~ReconfigureServer() {
  service_.shutdown();
  spinner_.stop();
}

// roscpp passes exceptions to the caller as the error of the service.
bool ReconfigureServer::onSet(Event& event) {
  const std::map<std::string, parameters::Value> before = changeable(table_);
  std::vector<std::string> errors = setFromReconfigure(table_, event.getRequest().config);
  if (errors.empty()) errors = validate_();
  if (!errors.empty()) {
    restore(table_, before);
    const std::string text = joined(errors);
    ROS_WARN_STREAM("parameters of " << event.getCallerName() << " refused: " << text);
    updates_.publish(valuesForReconfigure(table_));  // tools show the requested values until they receive an update
    std_msgs::String refusal;
    refusal.data = text;
    refusals_.publish(refusal);
    throw std::runtime_error(text);
  }
  commit_();
  event.getResponse().config = valuesForReconfigure(table_);
  updates_.publish(event.getResponse().config);
  logAndStore(event.getCallerName(), before);
  return true;
}

void ReconfigureServer::logAndStore(const std::string& caller, const std::map<std::string, parameters::Value>& before) {
  for (const auto& [name, value] : changeable(table_)) {
    const parameters::Value& old = before.at(name);
    if (value == old) continue;
    ROS_INFO_STREAM(caller << " changed " << node_.resolveName(name) << " from " << parameters::yamlText(old) << " to "
                           << parameters::yamlText(value));
    node_.setParam(name, toXmlRpc(value));
  }
}

}  // namespace laparoscope_servo
