// Reads the trees of parameters.h from the parameter server and from files.
#include <ros/node_handle.h>
#include <yaml-cpp/yaml.h>

#include <stdexcept>

#include "ros/common/parameters.h"

namespace laparoscope_servo {

namespace {

using XmlRpc::XmlRpcValue;

// Converts scalars as rosparam does (YAML 1.1 core): a quoted scalar is always a string.
XmlRpcValue fromScalar(const YAML::Node& node) {
  if (node.Tag() == "!") return XmlRpcValue(node.Scalar());
  int integer = 0;
  double number = 0.0;
  bool boolean = false;
  if (YAML::convert<int>::decode(node, integer)) return XmlRpcValue(integer);
  if (YAML::convert<double>::decode(node, number)) return XmlRpcValue(number);
  if (YAML::convert<bool>::decode(node, boolean)) return XmlRpcValue(boolean);
  return XmlRpcValue(node.Scalar());
}

XmlRpcValue fromYaml(const YAML::Node& node) {
  XmlRpcValue value;
  if (node.IsMap()) {
    value.begin();  // makes it a struct even if the map is empty
    for (const auto& entry : node) value[entry.first.as<std::string>()] = fromYaml(entry.second);
  } else if (node.IsSequence()) {
    value.setSize(static_cast<int>(node.size()));
    for (std::size_t k = 0; k < node.size(); ++k) value[static_cast<int>(k)] = fromYaml(node[k]);
  } else if (node.IsScalar()) {
    value = fromScalar(node);
  }
  return value;
}

}  // namespace

XmlRpcValue parametersOf(const ros::NodeHandle& node) {
  XmlRpcValue tree;
  node.getParam(node.getNamespace(), tree);
  return tree;
}

XmlRpcValue parametersFromYaml(const std::string& file) {
  try {
    const YAML::Node root = YAML::LoadFile(file);
    if (!root.IsMap() && !root.IsNull()) {
      throw std::runtime_error("parameter file '" + file + "' holds no mapping, expected lines of 'name: value'");
    }
    return fromYaml(root);
  } catch (const YAML::Exception& error) {
    throw std::runtime_error("parameter file '" + file + "': " + error.what());
  }
}

XmlRpcValue mergeParameters(const XmlRpcValue& base, const XmlRpcValue& overlay) {
  if (!overlay.valid()) return base;
  if (!base.valid() || base.getType() != XmlRpcValue::TypeStruct || overlay.getType() != XmlRpcValue::TypeStruct) {
    return overlay;
  }
  XmlRpcValue result = base;
  for (const auto& member : overlay) {
    result[member.first] = result.hasMember(member.first) ? mergeParameters(result[member.first], member.second)
                                                          : XmlRpcValue(member.second);
  }
  return result;
}

}  // namespace laparoscope_servo
