#include "ros/recording/session_facts.h"

#include <ros/package.h>
#include <sys/utsname.h>
#include <yaml-cpp/yaml.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <opencv2/core/version.hpp>
#include <regex>

namespace laparoscope_servo {

namespace {

constexpr std::uintmax_t kLargestFile = 65536;  // bytes; a calibration has some thousand

using Files = std::map<std::string, std::string>;

// From package.xml, which is installed too.
std::string packageVersion() {
  std::ifstream stream(ros::package::getPath("laparoscope_servo") + "/package.xml");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  std::smatch version;
  return std::regex_search(text, version, std::regex("<version>([^<]*)</version>")) ? version[1].str() : "unknown";
}

void keepFile(const std::string& name, Files& files) {
  const std::filesystem::path path(name);
  const std::string kind = path.extension();
  if (!path.is_absolute() || (kind != ".yaml" && kind != ".yml" && kind != ".ini")) return;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) || std::filesystem::file_size(path, error) > kLargestFile) return;
  std::ifstream stream(path);
  files[name] = {std::istreambuf_iterator<char>(stream), {}};
}

void emit(YAML::Emitter& yaml, XmlRpc::XmlRpcValue value, Files& files) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeStruct:
      yaml << YAML::BeginMap;
      for (auto& [name, member] : value) {
        if (name.find("password") != std::string::npos) continue;
        yaml << YAML::Key << name << YAML::Value;
        emit(yaml, member, files);
      }
      yaml << YAML::EndMap;
      return;
    case XmlRpc::XmlRpcValue::TypeArray:
      yaml << YAML::Flow << YAML::BeginSeq;
      for (int k = 0; k < value.size(); ++k) emit(yaml, value[k], files);
      yaml << YAML::EndSeq;
      return;
    case XmlRpc::XmlRpcValue::TypeBoolean:
      yaml << static_cast<bool>(value);
      return;
    case XmlRpc::XmlRpcValue::TypeInt:
      yaml << static_cast<int>(value);
      return;
    case XmlRpc::XmlRpcValue::TypeDouble:
      yaml << static_cast<double>(value);
      return;
    case XmlRpc::XmlRpcValue::TypeString:
      keepFile(static_cast<std::string>(value), files);
      yaml << YAML::DoubleQuoted << static_cast<std::string>(value);
      return;
    default:
      yaml << YAML::Null;
  }
}

}  // namespace

std::string sessionFacts(const XmlRpc::XmlRpcValue& parameters) {
  utsname system{};
  ::uname(&system);
  Files files;
  YAML::Emitter yaml;
  yaml << YAML::BeginMap << YAML::Key << "versions" << YAML::Value << YAML::BeginMap;
  yaml << YAML::Key << "laparoscope_servo" << YAML::Value << packageVersion();
  yaml << YAML::Key << "opencv" << YAML::Value << CV_VERSION;
  yaml << YAML::Key << "system" << YAML::Value << std::string(system.sysname) + " " + system.release;
  yaml << YAML::EndMap << YAML::Key << "parameters" << YAML::Value;
  emit(yaml, parameters, files);
  yaml << YAML::Key << "files" << YAML::Value << YAML::BeginMap;
  for (const auto& [name, content] : files) {
    yaml << YAML::Key << YAML::DoubleQuoted << name << YAML::Value << YAML::Literal << content;
  }
  yaml << YAML::EndMap << YAML::EndMap;
  return yaml.c_str();
}

}  // namespace laparoscope_servo
