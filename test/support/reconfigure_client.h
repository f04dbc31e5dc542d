// Asks a node to change parameters, as the tools of dynamic_reconfigure do, and hears what it says of them.
#pragma once

#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/ros.h>

#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>

namespace laparoscope_servo::test_support {

class ReconfigureClient {
 public:
  // `node`: its name. A spinner of the test's has to call.
  explicit ReconfigureClient(const std::string& node)
      : node_(node),
        description_subscriber_(handle_.subscribe<dynamic_reconfigure::ConfigDescription>(
            node + "/parameter_descriptions", 1,
            [this](const dynamic_reconfigure::ConfigDescriptionConstPtr& message) {
              const std::lock_guard<std::mutex> lock(mutex_);
              for (const auto& parameter : message->groups.at(0).parameters) types_[parameter.name] = parameter.type;
            })),
        update_subscriber_(handle_.subscribe<dynamic_reconfigure::Config>(
            node + "/parameter_updates", 10, [this](const dynamic_reconfigure::ConfigConstPtr& message) {
              const std::lock_guard<std::mutex> lock(mutex_);
              ++updates_;
              for (const auto& number : message->doubles) numbers_[number.name] = number.value;
            })) {}

  // Empty when it was accepted; "refused" when not: roscpp's clients are not told why.
  std::string set(const std::function<void(dynamic_reconfigure::Config&)>& fill) {
    dynamic_reconfigure::Reconfigure call;
    fill(call.request.config);
    if (!ros::service::waitForService(node_ + "/set_parameters", 20000)) return "no service";
    if (!ros::service::call(node_ + "/set_parameters", call)) return "refused";
    for (const auto& number : call.response.config.doubles) {
      const std::lock_guard<std::mutex> lock(mutex_);
      answered_[number.name] = number.value;
    }
    return "";
  }
  std::string set(const std::string& name, double value) {
    return set([&](dynamic_reconfigure::Config& config) { add(config, name, value); });
  }
  static void add(dynamic_reconfigure::Config& config, const std::string& name, double value) {
    config.doubles.emplace_back();
    config.doubles.back().name = name;
    config.doubles.back().value = value;
  }

  // -1: nothing was said of it.
  double updated(const std::string& name) const { return at(numbers_, name); }
  double answered(const std::string& name) const { return at(answered_, name); }
  int updates() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return updates_;
  }
  std::map<std::string, std::string> types() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return types_;
  }
  // What the parameter server has.
  double stored(const std::string& path) const {
    double value = -1.0;
    handle_.getParam(node_ + "/" + path, value);
    return value;
  }

 private:
  double at(const std::map<std::string, double>& numbers, const std::string& name) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = numbers.find(name);
    return found == numbers.end() ? -1.0 : found->second;
  }

  std::string node_;
  ros::NodeHandle handle_;
  mutable std::mutex mutex_;
  std::map<std::string, std::string> types_;
  std::map<std::string, double> numbers_;
  std::map<std::string, double> answered_;
  int updates_ = 0;
  ros::Subscriber description_subscriber_;
  ros::Subscriber update_subscriber_;
};

}  // namespace laparoscope_servo::test_support
