// Reads a tree of parameters, from the parameter server or from a YAML file, with the same checks for both.
//
// A parameter that is absent keeps the value that the configuration struct gives it; one that is there must have the
// right type and lie in its range. Every error is kept, so that a user sees all of them at once; the node then refuses
// to start.
#pragma once

#include <XmlRpcValue.h>

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "laparoscope_servo/parameters/table.h"

namespace ros {
class NodeHandle;
}

namespace laparoscope_servo {

class ParameterReader {
 public:
  // `tree` is a struct of parameters or invalid (none are set); `name` is what its root is called in errors, e.g.
  // "/tracker".
  explicit ParameterReader(const XmlRpc::XmlRpcValue& tree, const std::string& name);

  // All that the table tells of; what is absent stays as it is, unless it is required. Ranges are judged, but not how
  // parameters lie to each other: that is left to validate(), of all of them.
  void read(const parameters::Table& table);
  // All parameters of a node: reads them, judges them together by the configuration's own validate(), and refuses
  // others in its namespace.
  template <class Config>
  void readAll(Config& config) {
    parameters::Table table;
    describe(table, config);
    read(table);
    refuseUnknownOfNode();
    addJudgement(validate(config));
  }

  // What the table tells of is known, though nobody here reads it.
  void allow(const parameters::Table& table);

  // Paths are relative to the root, with slashes: "tracking/levels".
  bool has(const std::string& path) const;
  // Adds an error for each parameter under `group` that nobody has read, with the nearest name that was: a typing error
  // in a file must not go unnoticed. An empty `group` stands for the root.
  void refuseUnknown(const std::string& group);
  // The same for all that a node has in its namespace, but for what libraries read there: diagnostic_updater's period,
  // and what image_transport's plugins keep under the names of topics.
  void refuseUnknownOfNode();
  void addError(const std::string& error) { errors_.push_back(error); }
  // Errors of validate(), which begin with the parameter's path; what was said already is not said again.
  void addJudgement(const std::vector<std::string>& errors);

  const std::vector<std::string>& errors() const { return errors_; }
  // All errors, one a line, with a heading; empty when there are none.
  std::string report() const;

 private:
  void read(const parameters::Row& row, const XmlRpc::XmlRpcValue& value);
  void take(const parameters::Row& row, const parameters::Value& value);
  // "; is X meant?" of the name that was read and is most like it, or nothing.
  std::string suggestion(const std::string& path) const;
  const XmlRpc::XmlRpcValue* find(const std::string& path) const;
  // The value at `path`, marked as read; null when absent.
  const XmlRpc::XmlRpcValue* take(const std::string& path);
  void wrongType(const std::string& path, const XmlRpc::XmlRpcValue& value, const std::string& expected);
  std::string full(const std::string& path) const { return name_ + "/" + path; }

  XmlRpc::XmlRpcValue tree_;
  std::string name_;
  std::set<std::string> read_;
  std::set<std::string> settled_;  // of which nothing more is to be said, a library's or refused already
  std::vector<std::string> errors_;
};

// All parameters under the handle's namespace, as a struct; invalid when there are none.
XmlRpc::XmlRpcValue parametersOf(const ros::NodeHandle& node);

// The parameters of a YAML file, as rosparam would load them. Throws std::runtime_error that names the file, and the
// line where it cannot be parsed.
XmlRpc::XmlRpcValue parametersFromYaml(const std::string& file);

// `overlay` laid over `base`: structs are merged key by key, everything else is replaced.
XmlRpc::XmlRpcValue mergeParameters(const XmlRpc::XmlRpcValue& base, const XmlRpc::XmlRpcValue& overlay);

}  // namespace laparoscope_servo
