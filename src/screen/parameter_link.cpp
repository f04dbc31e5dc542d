#include "screen/parameter_link.h"

#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/service.h>

#include <QLocale>
#include <QString>
#include <chrono>
#include <memory>
#include <thread>

#include "ros/common/reconfigure_messages.h"

namespace laparoscope_servo::screen {

namespace {

const char* const kNodes[] = {"tracker", "controller"};
constexpr int kLooks = 20;  // tries to find the reason of a refusal, which comes on another connection
constexpr std::chrono::milliseconds kLookPause{10};

template <class List, class Take>
bool find(const List& list, const std::string& name, const Take& take) {
  for (const auto& entry : list) {
    if (entry.name != name) continue;
    take(entry.value);
    return true;
  }
  return false;
}

std::string textOf(double value) {
  return QString::number(value, 'g', 6).toStdString();
}

bool readRange(const dynamic_reconfigure::Config& config, const std::string& name, double& bound) {
  const auto take = [&](double value) { bound = value; };
  return find(config.doubles, name, take) || find(config.ints, name, take);
}

}  // namespace

std::vector<LiveParameter> rowsOf(const std::string& node, const dynamic_reconfigure::ConfigDescription& description,
                                  const dynamic_reconfigure::Config& values) {
  std::vector<LiveParameter> rows;
  for (const auto& group : description.groups) {
    for (const auto& parameter : group.parameters) {
      LiveParameter row{node, parameter.name, parameter.type, parameter.description, "", 0.0, 0.0};
      const bool known = find(values.doubles, row.name, [&](double value) { row.value = textOf(value); }) ||
                         find(values.ints, row.name, [&](int value) { row.value = std::to_string(value); }) ||
                         find(values.bools, row.name, [&](bool value) { row.value = value ? "true" : "false"; }) ||
                         find(values.strs, row.name, [&](const std::string& value) { row.value = value; });
      if (!known) continue;
      readRange(description.min, row.name, row.low);
      readRange(description.max, row.name, row.high);
      rows.push_back(row);
    }
  }
  return rows;
}

std::optional<dynamic_reconfigure::Config> requestOf(const LiveParameter& parameter, const std::string& text) {
  dynamic_reconfigure::Config config;
  const QString trimmed = QString::fromStdString(text).trimmed();
  bool valid = true;
  if (parameter.type == "double") {
    appendTo(config.doubles, parameter.name, QLocale::c().toDouble(trimmed, &valid));
  } else if (parameter.type == "int") {
    appendTo(config.ints, parameter.name, QLocale::c().toInt(trimmed, &valid));
  } else if (parameter.type == "bool") {
    valid = trimmed == "true" || trimmed == "false";
    appendTo(config.bools, parameter.name, trimmed == "true");
  } else {
    appendTo(config.strs, parameter.name, text);
  }
  return valid ? std::make_optional(config) : std::nullopt;
}

void ParameterLink::connect(ros::NodeHandle& node) {
  for (const std::string name : kNodes) {
    const std::lock_guard<std::mutex> lock(mutex_);
    nodes_[name].service = node.resolveName(name + "/set_parameters");
    const auto listen = [&](auto example, const std::string& topic, const auto& take) {
      using Message = decltype(example);
      const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
          [this, name, take](const boost::shared_ptr<const Message>& message) {
            {
              const std::lock_guard<std::mutex> taken(mutex_);
              take(nodes_[name], *message);
            }
            publish();
          };
      subscribers_.push_back(node.subscribe<Message>(name + "/" + topic, 5, callback));
    };
    listen(dynamic_reconfigure::ConfigDescription(), "parameter_descriptions",
           [](Node& of, const dynamic_reconfigure::ConfigDescription& message) { of.description = message; });
    listen(dynamic_reconfigure::Config(), "parameter_updates",
           [](Node& of, const dynamic_reconfigure::Config& message) { of.values = message; });
    const boost::function<void(const std_msgs::StringConstPtr&)> refused =
        [refusals = refusals_, name](const std_msgs::StringConstPtr& message) {
          const std::lock_guard<std::mutex> taken(refusals->mutex);
          refusals->words[name] = message->data;
        };
    subscribers_.push_back(node.subscribe<std_msgs::String>(name + "/parameters_refused", 5, refused));
  }
}

void ParameterLink::disconnect() {
  std::vector<ros::Subscriber> gone;
  const std::lock_guard<std::mutex> lock(mutex_);
  gone.swap(subscribers_);
  nodes_.clear();
}

void ParameterLink::publish() {
  auto rows = std::make_shared<std::vector<LiveParameter>>();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto& [name, node] : nodes_) {
      const std::vector<LiveParameter> more = rowsOf(name, node.description, node.values);
      rows->insert(rows->end(), more.begin(), more.end());
    }
  }
  keeper_.change([&](Facts& facts) { facts.parameters = rows; });
}

void ParameterLink::set(const LiveParameter& parameter, const std::string& text) {
  const std::string what = parameter.name + " = " + text;
  const std::optional<dynamic_reconfigure::Config> config = requestOf(parameter, text);
  if (!config) return told_({what, "'" + text + "' is no value; expected " + parameter.meaning, Outcome::kRefused});
  std::string service;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    service = nodes_[parameter.node].service;
  }
  refusals_->take(parameter.node);
  told_({what, "", Outcome::kWaiting});
  calls_.ask([this, what, config, service, refusals = refusals_, node = parameter.node]() -> std::function<void()> {
    dynamic_reconfigure::Reconfigure call;
    call.request.config = *config;
    const bool done = ros::service::call(service, call);
    Answer answer{what, "", done ? Outcome::kDone : Outcome::kRefused};
    for (int look = 0; look < kLooks && !done && answer.text.empty(); ++look) {
      std::this_thread::sleep_for(kLookPause);
      answer.text = refusals->take(node);
    }
    if (!done && answer.text.empty()) answer.text = "the " + node + " does not say why";
    return [this, answer] { told_(answer); };
  });
}

// Takes and removes the refusal of a node.
std::string ParameterLink::Refusals::take(const std::string& node) {
  const std::lock_guard<std::mutex> lock(mutex);
  std::string text;
  text.swap(words[node]);
  return text;
}

}  // namespace laparoscope_servo::screen
