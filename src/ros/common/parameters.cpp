#include "ros/common/parameters.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace laparoscope_servo {

namespace {

using XmlRpc::XmlRpcValue;

std::string typeName(const XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return "a boolean";
    case XmlRpcValue::TypeInt:
      return "an integer";
    case XmlRpcValue::TypeDouble:
      return "a number";
    case XmlRpcValue::TypeString:
      return "a string";
    case XmlRpcValue::TypeArray:
      return "a list";
    case XmlRpcValue::TypeStruct:
      return "a group of parameters";
    default:
      return "of no known type";
  }
}

std::string text(const XmlRpcValue& value) {
  std::ostringstream stream;
  if (value.getType() == XmlRpcValue::TypeString) {
    stream << '\'' << static_cast<const std::string&>(value) << '\'';
  } else if (value.getType() == XmlRpcValue::TypeBoolean) {
    stream << (static_cast<const bool&>(value) ? "true" : "false");
  } else if (value.getType() == XmlRpcValue::TypeInt || value.getType() == XmlRpcValue::TypeDouble) {
    value.write(stream);
  }
  return stream.str();
}

// Insertions, deletions and replacements that make one of the other (Levenshtein).
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

// image_transport's plugins keep theirs in <topic>/<plugin>/, and which of them to load beside that.
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
  const std::string content = text(value);
  errors_.push_back(full(path) + (content.empty() ? "" : " = " + content) + " is " + typeName(value) + ", expected " +
                    expected);
}

bool ParameterReader::number(const XmlRpcValue& value, double& result) const {
  if (value.getType() == XmlRpcValue::TypeInt) {
    result = static_cast<const int&>(value);
  } else if (value.getType() == XmlRpcValue::TypeDouble) {
    result = static_cast<const double&>(value);
  } else {
    return false;
  }
  return true;
}

void ParameterReader::read(const std::string& path, double& value, double minimum, double maximum) {
  const XmlRpcValue* found = take(path);
  if (found == nullptr) return;
  std::ostringstream range;
  range << "a number";
  if (std::isfinite(minimum) || std::isfinite(maximum)) range << " from " << minimum << " to " << maximum;
  double result = 0.0;
  if (!number(*found, result)) return wrongType(path, *found, range.str());
  if (!(result >= minimum && result <= maximum)) {
    std::ostringstream error;
    error << full(path) << " = " << result << ", expected " << range.str();
    errors_.push_back(error.str());
    return;
  }
  value = result;
}

void ParameterReader::read(const std::string& path, int& value, int minimum, int maximum) {
  const XmlRpcValue* found = take(path);
  if (found == nullptr) return;
  const std::string range = "an integer from " + std::to_string(minimum) + " to " + std::to_string(maximum);
  if (found->getType() != XmlRpcValue::TypeInt) return wrongType(path, *found, range);
  const int result = static_cast<const int&>(*found);
  if (result < minimum || result > maximum) {
    errors_.push_back(full(path) + " = " + std::to_string(result) + ", expected " + range);
    return;
  }
  value = result;
}

void ParameterReader::read(const std::string& path, bool& value) {
  const XmlRpcValue* found = take(path);
  if (found == nullptr) return;
  if (found->getType() != XmlRpcValue::TypeBoolean) return wrongType(path, *found, "true or false");
  value = static_cast<const bool&>(*found);
}

void ParameterReader::read(const std::string& path, std::string& value) {
  const XmlRpcValue* found = take(path);
  if (found == nullptr) return;
  if (found->getType() != XmlRpcValue::TypeString) return wrongType(path, *found, "a string");
  value = static_cast<const std::string&>(*found);
}

void ParameterReader::read(const std::string& path, std::string& value, const std::vector<std::string>& choices) {
  const std::size_t errors_before = errors_.size();
  std::string result = value;
  read(path, result);
  if (errors_.size() != errors_before) return;
  std::string list;
  for (const std::string& choice : choices) {
    if (result == choice) {
      value = result;
      return;
    }
    list += (list.empty() ? "" : ", ") + choice;
  }
  errors_.push_back(full(path) + " = '" + result + "', expected one of: " + list);
}

void ParameterReader::read(const std::string& path, std::vector<double>& value, std::size_t size, double minimum,
                           double maximum) {
  const XmlRpcValue* found = take(path);
  if (found == nullptr) return;
  std::ostringstream expected;
  expected << "a list of " << (size > 0 ? std::to_string(size) + " " : "") << "numbers from " << minimum << " to "
           << maximum;
  if (found->getType() != XmlRpcValue::TypeArray) return wrongType(path, *found, expected.str());
  std::vector<double> result;
  for (int k = 0; k < found->size(); ++k) {
    double element = 0.0;
    const XmlRpcValue& item = (*found)[k];
    if (!number(item, element)) return wrongType(path + "[" + std::to_string(k) + "]", item, expected.str());
    if (!(element >= minimum && element <= maximum)) {
      std::ostringstream error;
      error << full(path) << "[" << k << "] = " << element << ", expected " << expected.str();
      errors_.push_back(error.str());
      return;
    }
    result.push_back(element);
  }
  if (size > 0 && result.size() != size) {
    errors_.push_back(full(path) + " has " + std::to_string(result.size()) + " elements, expected " + expected.str());
    return;
  }
  value = result;
}

void ParameterReader::read(const std::string& path, std::vector<std::string>& value) {
  const XmlRpcValue* found = take(path);
  if (found == nullptr) return;
  if (found->getType() != XmlRpcValue::TypeArray) return wrongType(path, *found, "a list of strings");
  std::vector<std::string> result;
  for (int k = 0; k < found->size(); ++k) {
    const XmlRpcValue& item = (*found)[k];
    if (item.getType() != XmlRpcValue::TypeString)
      return wrongType(path + "[" + std::to_string(k) + "]", item, "a string");
    result.push_back(static_cast<const std::string&>(item));
  }
  value = result;
}

bool ParameterReader::has(const std::string& path) const {
  const XmlRpcValue* value = find(path);
  return value != nullptr && value->valid();
}

void ParameterReader::require(const std::string& path, const std::string& what) {
  if (!has(path)) errors_.push_back(full(path) + " is not set, expected " + what);
}

std::string ParameterReader::suggestion(const std::string& path) const {
  std::string nearest;
  std::size_t least = path.size();
  for (const std::string& known : read_) {
    const std::size_t distance = editDistance(path, known);
    if (distance >= least) continue;
    least = distance;
    nearest = known;
  }
  // A slip of the finger or two, or the right name in the wrong group.
  const auto name = [](const std::string& whole) { return whole.substr(whole.rfind('/') + 1); };
  if (least > 2 && name(nearest) != name(path)) {
    nearest.clear();
    for (const std::string& known : read_) {
      if (name(known) == name(path)) nearest = known;
    }
  }
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
      settled_.insert(path);  // said once, also when a larger group is asked about later
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
