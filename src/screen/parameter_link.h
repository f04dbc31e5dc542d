// Reads and changes the nodes' parameters that may change while they run, by the protocol of dynamic_reconfigure.
#pragma once

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <std_msgs/String.h>

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "screen/fact_keeper.h"
#include "screen/newest_call.h"

namespace laparoscope_servo::screen {

// The rows of a node, with the values of `values`. Parameters of unknown types are omitted.
std::vector<LiveParameter> rowsOf(const std::string& node, const dynamic_reconfigure::ConfigDescription& description,
                                  const dynamic_reconfigure::Config& values);

// A request to set a parameter; empty if the text is not of its type.
std::optional<dynamic_reconfigure::Config> requestOf(const LiveParameter& parameter, const std::string& text);

class ParameterLink {
 public:
  // `told`: called with the result of a change, from the link's threads.
  ParameterLink(FactKeeper& keeper, const std::function<void(const Answer&)>& told) : keeper_(keeper), told_(told) {}

  void connect(ros::NodeHandle& node);
  void disconnect();
  void set(const LiveParameter& parameter, const std::string& text);

 private:
  struct Node {
    dynamic_reconfigure::ConfigDescription description;
    dynamic_reconfigure::Config values;
    std::string service;
  };
  // Refusals of the last changes, by node; shared with the threads that wait for them.
  struct Refusals {
    std::mutex mutex;
    std::map<std::string, std::string> words;
    std::string take(const std::string& node);
  };
  void publish();

  FactKeeper& keeper_;
  std::function<void(const Answer&)> told_;
  std::mutex mutex_;
  std::map<std::string, Node> nodes_;
  std::shared_ptr<Refusals> refusals_ = std::make_shared<Refusals>();
  std::vector<ros::Subscriber> subscribers_;
  NewestCall calls_;
};

}  // namespace laparoscope_servo::screen
