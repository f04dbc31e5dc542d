#include "ros/common/parameters.h"

#include <algorithm>
#include <optional>
#include <sstream>

#include "laparoscope_servo/parameters/nearest_name.h"

namespace laparoscope_servo {

namespace {

using XmlRpc::XmlRpcValue;

// The value of a scalar; empty for a group, a list, and a value without a type.
std::optional<parameters::Value> fromXmlRpc(const XmlRpcValue& value) {
  using parameters::Value;
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return Value(static_cast<const bool&>(value));
    case XmlRpcValue::TypeInt:
      return Value(static_cast<const int&>(value));
    case XmlRpcValue::TypeDouble:
      return Value(static_cast<const double&>(value));
    case XmlRpcValue::TypeString:
      return Value(static_cast<const std::string&>(value));
    default:
      return std::nullopt;
  }
}

std::string typeName(const XmlRpcValue& value) {
  if (const auto scalar = fromXmlRpc(value)) return parameters::typeName(*scalar);
  if (value.getType() == XmlRpcValue::TypeArray) return "a list";
  return value.getType() == XmlRpcValue::TypeStruct ? "a group of parameters" : "of no known type";
}

// image_transport's plugins keep their parameters in <topic>/<plugin>/, and the list of plugins to load beside it.
bool isOfImageTransport(const XmlRpcValue& group) {
  if (group.getType() != XmlRpcValue::TypeStruct) return false;
  for (const char* name : {"compressed", "compressedDepth", "theora", "zstd", "disable_pub_plugins"}) {
    if (group.hasMember(name)) return true;
  }
  return false;
}

}  // namespace

ParameterReader::ParameterReader(const XmlRpcValue& tree, const std::string& name) : tree_(tree), name_(name) {
  if (tree_.valid() && tree_.getType() != XmlRpcValue::TypeStruct) {
    errors_.push_back(name_ + " is " + typeName(tree_) + ", expected a group of parameters");
    tree_.clear();
  }
}

const XmlRpcValue* ParameterReader::find(const std::string& path) const {
  const XmlRpcValue* value = &tree_;
  std::istringstream parts(path);
  for (std::string part; std::getline(parts, part, '/');) {
    if (!value->valid() || value->getType() != XmlRpcValue::TypeStruct || !value->hasMember(part)) return nullptr;
    value = &(*value)[part];
  }
  return value;
}

const XmlRpcValue* ParameterReader::take(const std::string& path) {
  read_.insert(path);
  const XmlRpcValue* value = find(path);
  return value != nullptr && value->valid() ? value : nullptr;
}

void ParameterReader::wrongType(const std::string& path, const XmlRpcValue& value, const std::string& expected) {
  const auto scalar = fromXmlRpc(value);
  const std::string content = scalar ? parameters::valueText(*scalar) : "";
  errors_.push_back(full(path) + (content.empty() ? "" : " = " + content) + " is " + typeName(value) + ", expected " +
                    expected);
}

void ParameterReader::read(const parameters::Table& table) {
  for (const parameters::Row& row : table.rows()) {
    const XmlRpcValue* found = take(row.name);
    if (found != nullptr) {
      read(row, *found);
    } else if (row.is_required) {
      errors_.push_back(full(row.name) + " is not set, expected " + row.expected() + ", e.g. " + row.example);
    }
  }
}

void ParameterReader::read(const parameters::Row& row, const XmlRpcValue& value) {
  if (value.getType() != XmlRpcValue::TypeArray) {
    const auto scalar = fromXmlRpc(value);
    if (!scalar) return wrongType(row.name, value, row.expected());
    return take(row, *scalar);
  }
  const bool of_texts = row.kind == parameters::Row::Kind::kTexts;
  if (!of_texts && row.kind != parameters::Row::Kind::kNumbers) return wrongType(row.name, value, row.expected());
  std::vector<double> numbers;
  std::vector<std::string> texts;
  for (int k = 0; k < value.size(); ++k) {
    const auto element = fromXmlRpc(value[k]);
    const auto* text = element ? std::get_if<std::string>(&*element) : nullptr;
    const std::optional<double> number = element ? parameters::numberOf(*element) : std::nullopt;
    if (of_texts ? text == nullptr : !number)
      return wrongType(row.name + "[" + std::to_string(k) + "]", value[k], row.expected());
    if (of_texts) texts.push_back(*text);
    if (!of_texts) numbers.push_back(*number);
  }
  return of_texts ? take(row, texts) : take(row, numbers);
}

void ParameterReader::take(const parameters::Row& row, const parameters::Value& value) {
  const std::string error = row.take(value);
  if (!error.empty()) errors_.push_back(full(row.name) + error);
}

void ParameterReader::allow(const parameters::Table& table) {
  for (const parameters::Row& row : table.rows()) read_.insert(row.name);
}

void ParameterReader::addJudgement(const std::vector<std::string>& errors) {
  for (const std::string& error : errors) {
    if (std::find(errors_.begin(), errors_.end(), full(error)) == errors_.end()) errors_.push_back(full(error));
  }
}

bool ParameterReader::has(const std::string& path) const {
  const XmlRpcValue* value = find(path);
  return value != nullptr && value->valid();
}

std::string ParameterReader::suggestion(const std::string& path) const {
  const std::string nearest = parameters::nearestName(read_, path);
  return nearest.empty() ? "" : "; is " + full(nearest) + " meant?";
}

void ParameterReader::refuseUnknownOfNode() {
  if (!tree_.valid()) return;
  settled_.insert("diagnostic_period");
  for (const auto& member : tree_) {
    if (isOfImageTransport(member.second)) settled_.insert(member.first);
  }
  refuseUnknown("");
}

void ParameterReader::refuseUnknown(const std::string& group) {
  const XmlRpcValue* value = find(group);
  if (value == nullptr || value->getType() != XmlRpcValue::TypeStruct) return;
  for (const auto& member : (*value)) {
    const std::string path = group.empty() ? member.first : group + "/" + member.first;
    if (settled_.count(path) > 0) continue;
    if (member.second.getType() == XmlRpcValue::TypeStruct) {
      refuseUnknown(path);
    } else if (read_.count(path) == 0) {
      errors_.push_back(full(path) + " is no parameter of this program" + suggestion(path));
      settled_.insert(path);  // reported once, also if a larger group is checked later
    }
  }
}

std::string ParameterReader::report() const {
  if (errors_.empty()) return "";
  std::string text =
      std::to_string(errors_.size()) + (errors_.size() == 1 ? " error" : " errors") + " in the parameters:";
  for (const std::string& error : errors_) text += "\n  " + error;
  return text;
}

}  // namespace laparoscope_servo
