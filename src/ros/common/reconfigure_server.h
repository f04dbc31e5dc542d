// Parameters that change while a node runs, by the protocol of dynamic_reconfigure.
//
// Service `~set_parameters` (dynamic_reconfigure/Reconfigure); topics `~parameter_descriptions`
// (dynamic_reconfigure/ConfigDescription) and `~parameter_updates` (dynamic_reconfigure/Config), both latched. A set is
// accepted or refused as a whole. The caller gets all errors as the error of the service; since roscpp hides that from
// its clients, they are also published on `~parameters_refused` (std_msgs/String). Accepted values are logged,
// published, and put on the parameter server. All of this happens in a separate thread; the node takes the new
// configuration at a time of its choice.
#pragma once

#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "laparoscope_servo/parameters/table.h"
#include "ros/common/handover.h"

namespace laparoscope_servo {

class ReconfigureServer {
 public:
  // `table` belongs to a configuration that only this server uses; `validate` checks it, `commit` passes on a copy of
  // it.
  ReconfigureServer(const ros::NodeHandle& private_node, const parameters::Table& table,
                    const std::function<std::vector<std::string>()>& validate, const std::function<void()>& commit);
  ~ReconfigureServer();
  ReconfigureServer(const ReconfigureServer&) = delete;
  ReconfigureServer& operator=(const ReconfigureServer&) = delete;

 private:
  using Event = ros::ServiceEvent<dynamic_reconfigure::ReconfigureRequest, dynamic_reconfigure::ReconfigureResponse>;

  bool onSet(Event& event);
  void logAndStore(const std::string& caller, const std::map<std::string, parameters::Value>& before);

  const parameters::Table& table_;
  std::function<std::vector<std::string>()> validate_;
  std::function<void()> commit_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;  // private handle with that queue
  ros::Publisher descriptions_;
  ros::Publisher updates_;
  ros::Publisher refusals_;
  ros::ServiceServer service_;
  ros::AsyncSpinner spinner_;
};

// The parameters of a node that may change while it runs. Config has describe() and validate().
template <class Config>
class LiveParameters {
 public:
  LiveParameters(const ros::NodeHandle& private_node, const Config& config)
      : config_(config),
        table_(tableOf(config_)),
        server_(
            private_node, table_, [this] { return validate(config_); }, [this] { handover_.give(config_); }) {}

  // Takes the configuration set since the last call. Does not wait nor allocate.
  bool take(Config& config) { return handover_.take(config); }

 private:
  static parameters::Table tableOf(Config& config) {
    parameters::Table table;
    describe(table, config);
    return table;
  }

  Config config_;  // used by the server's thread only
  const parameters::Table table_;
  Handover<Config> handover_;
  ReconfigureServer server_;  // last: its thread uses all of the above
};

}  // namespace laparoscope_servo
