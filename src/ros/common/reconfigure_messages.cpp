#include "ros/common/reconfigure_messages.h"

#include <limits>
#include <set>

#include "laparoscope_servo/parameters/nearest_name.h"
#include "laparoscope_servo/parameters/pages.h"

namespace laparoscope_servo {

namespace {

using dynamic_reconfigure::Config;
using parameters::Row;
using parameters::Table;
using parameters::Value;

constexpr char kSlash[] = "__";

std::string typeOf(const Row& row) {
  return row.kind == Row::Kind::kText ? "str" : parameters::typeText(row);
}

// The protocol has no lists; none of them may change while a node runs.
void add(Config& config, const Row& row, const Value& value) {
  const std::string name = reconfigureName(row.name);
  if (const auto* flag = std::get_if<bool>(&value)) appendTo(config.bools, name, *flag);
  if (const auto* integer = std::get_if<int>(&value)) appendTo(config.ints, name, *integer);
  if (const auto* number = std::get_if<double>(&value)) appendTo(config.doubles, name, *number);
  if (const auto* text = std::get_if<std::string>(&value)) appendTo(config.strs, name, *text);
}

Config withRoot() {
  Config config;
  dynamic_reconfigure::GroupState root;
  root.name = "Default";
  root.state = true;
  config.groups.push_back(root);
  return config;
}

Value bound(const Row& row, bool upper) {
  const double end = upper ? row.range.high : row.range.low;
  if (row.kind == Row::Kind::kFlag) return upper;
  if (row.kind == Row::Kind::kInteger) return static_cast<int>(end);
  if (row.kind == Row::Kind::kNumber) return end;
  return std::string();
}

class Setter {
 public:
  explicit Setter(const Table& table) : table_(table) {}

  void set(const std::string& name, const Value& value) {
    constexpr std::size_t kLongest = 200;  // longest name that is repeated in an error
    if (name.size() > kLongest) {
      errors_.push_back("a name of " + std::to_string(name.size()) + " characters is no parameter of this node");
      return;
    }
    const std::string path = pathOfReconfigureName(name);
    const Row* row = table_.find(path);
    if (row == nullptr) {
      const std::string nearest = parameters::nearestName(table_.names(), path);
      errors_.push_back(path + " is no parameter of this node" +
                        (nearest.empty() ? "" : "; is " + nearest + " meant?"));
    } else if (!row->while_running) {
      errors_.push_back(path + " may not change while the node runs");
    } else if (!named_.insert(path).second) {
      errors_.push_back(path + " is there twice");
    } else {
      const std::string error = row->take(value);
      if (!error.empty()) errors_.push_back(path + error);
    }
  }
  const std::vector<std::string>& errors() const { return errors_; }

 private:
  const Table& table_;
  std::set<std::string> named_;
  std::vector<std::string> errors_;
};

}  // namespace

std::string reconfigureName(const std::string& path) {
  std::string name;
  for (const char c : path) name += c == '/' ? std::string(kSlash) : std::string(1, c);
  return name;
}

std::string pathOfReconfigureName(const std::string& name) {
  std::string path = name;
  for (std::size_t at = path.find(kSlash); at != std::string::npos; at = path.find(kSlash)) path.replace(at, 2, "/");
  return path;
}

dynamic_reconfigure::ConfigDescription describeForReconfigure(const Table& table) {
  dynamic_reconfigure::ConfigDescription description;
  description.min = description.max = withRoot();
  dynamic_reconfigure::Group group;
  group.name = "Default";
  for (const Row& row : table.rows()) {
    if (!row.while_running) continue;
    dynamic_reconfigure::ParamDescription parameter;
    parameter.name = reconfigureName(row.name);
    parameter.type = typeOf(row);
    parameter.description = row.expected() + ": " + row.meaning;
    group.parameters.push_back(parameter);
    add(description.min, row, bound(row, false));
    add(description.max, row, bound(row, true));
  }
  description.groups.push_back(group);
  description.dflt = valuesForReconfigure(table);
  return description;
}

Config valuesForReconfigure(const Table& table) {
  Config config = withRoot();
  for (const Row& row : table.rows()) {
    if (row.while_running) add(config, row, row.get());
  }
  return config;
}

std::vector<std::string> setFromReconfigure(const Table& table, const Config& wanted) {
  const std::map<std::string, Value> before = changeable(table);
  Setter setter(table);
  for (const auto& parameter : wanted.bools) setter.set(parameter.name, static_cast<bool>(parameter.value));
  for (const auto& parameter : wanted.ints) setter.set(parameter.name, static_cast<int>(parameter.value));
  for (const auto& parameter : wanted.doubles) setter.set(parameter.name, static_cast<double>(parameter.value));
  for (const auto& parameter : wanted.strs) setter.set(parameter.name, static_cast<std::string>(parameter.value));
  if (!setter.errors().empty()) restore(table, before);
  return setter.errors();
}

std::map<std::string, Value> changeable(const Table& table) {
  std::map<std::string, Value> values;
  for (const Row& row : table.rows()) {
    if (row.while_running) values[row.name] = row.get();
  }
  return values;
}

void restore(const Table& table, const std::map<std::string, Value>& values) {
  for (const auto& [name, value] : values) table.find(name)->set(value);
}

}  // namespace laparoscope_servo
