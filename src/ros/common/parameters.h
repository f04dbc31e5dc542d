// Reads a tree of parameters, from the parameter server or from a YAML file, with the same checks for both.
//
// A parameter that is absent keeps its default from the configuration struct, unless it is required; one that is set
// must have the right type and lie in its range. Every error is kept, so that a user sees all of them at once; the node
// then refuses to start.
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
  // `tree` is a struct of parameters, or invalid if none are set; `name`: name of its root in errors, e.g. "/tracker".
  explicit ParameterReader(const XmlRpc::XmlRpcValue& tree, const std::string& name);

  // Reads all parameters of the table; absent ones keep their values, unless they are required. Checks ranges;
  // relations between parameters are left to validate().
  void read(const parameters::Table& table);
  // Reads all parameters of a node, checks them with the configuration's validate(), and refuses unknown ones in its
  // namespace.
  template <class Config>
  void readAll(Config& config) {
    parameters::Table table;
    describe(table, config);
    read(table);
    refuseUnknownOfNode();
    addJudgement(validate(config));
  }

  // Marks the parameters of the table as known without reading them.
  void allow(const parameters::Table& table);

  // Paths are relative to the root, with slashes: "tracking/levels".
  bool has(const std::string& path) const;
  // Adds an error for each parameter under `group` that was not read, with the nearest known name, so that typing
  // errors are noticed. An empty `group` stands for the root.
  void refuseUnknown(const std::string& group);
  // refuseUnknown() for the whole namespace of a node, except parameters of libraries: diagnostic_updater's period, and
  // those of image_transport's plugins under the names of topics.
  void refuseUnknownOfNode();
  void addError(const std::string& error) { errors_.push_back(error); }
  // Adds errors of validate(), which begin with the parameter's path; parameters that have an error already are
  // skipped.
  void addJudgement(const std::vector<std::string>& errors);

  const std::vector<std::string>& errors() const { return errors_; }
  // All errors, one per line, with a heading; empty if there are none.
  std::string report() const;

 private:
  void read(const parameters::Row& row, const XmlRpc::XmlRpcValue& value);
  void take(const parameters::Row& row, const parameters::Value& value);
  // "; is X meant?" with the most similar known name, or empty.
  std::string suggestion(const std::string& path) const;
  const XmlRpc::XmlRpcValue* find(const std::string& path) const;
  // The value at `path`, marked as read; null when absent.
  const XmlRpc::XmlRpcValue* take(const std::string& path);
  void wrongType(const std::string& path, const XmlRpc::XmlRpcValue& value, const std::string& expected);
  std::string full(const std::string& path) const { return name_ + "/" + path; }

  XmlRpc::XmlRpcValue tree_;
  std::string name_;
  std::set<std::string> read_;
  std::set<std::string> settled_;  // paths that need no further error: of libraries, or refused already
  std::vector<std::string> errors_;
};

// All parameters in the handle's namespace, as a struct; invalid if there are none.
XmlRpc::XmlRpcValue parametersOf(const ros::NodeHandle& node);

// The parameters of a YAML file, as rosparam would load them. Throws std::runtime_error that names the file, and the
// line where it cannot be parsed.
XmlRpc::XmlRpcValue parametersFromYaml(const std::string& file);

// Merges `overlay` into `base`: structs key by key; all else is replaced.
XmlRpc::XmlRpcValue mergeParameters(const XmlRpc::XmlRpcValue& base, const XmlRpc::XmlRpcValue& overlay);

}  // namespace laparoscope_servo
