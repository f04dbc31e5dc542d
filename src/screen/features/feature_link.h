// Finds the trackers of features by the type of what they publish, and subscribes to them.
#pragma once

#include <XmlRpcValue.h>
#include <laparoscope_servo/TrackedFeatures.h>
#include <ros/node_handle.h>

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "ros/common/master_client.h"

namespace laparoscope_servo::screen {

// The names of the nodes in `space`, a resolved namespace, that publish TrackedFeatures as `~features`; sorted.
// `answer`: of the master, to getPublishedTopics. Empty for an answer that is none.
std::vector<std::string> featureTrackersIn(XmlRpc::XmlRpcValue answer, const std::string& space);

class FeatureLink {
 public:
  using Connected = std::vector<std::pair<std::string, bool>>;
  using Take = std::function<void(const std::string& tracker, const TrackedFeatures& message)>;

  // Construct it after ros::start. `take` is called from the threads of the callback queue of `node`, which is in the
  // cart's namespace.
  FeatureLink(const ros::NodeHandle& node, const Take& take);

  // Asks the master, for half a second at most, and subscribes to new ones. Not from two threads at once.
  void find();
  // Which trackers are known, and whether they are there.
  Connected connected() const;
  // `take` is not called any more; find() ends soon.
  void close();

 private:
  void take(const std::string& tracker, const TrackedFeatures& message);

  ros::NodeHandle node_;
  MasterClient client_;
  std::atomic<bool> ends_{false};
  mutable std::mutex mutex_;
  Take take_;
  std::map<std::string, ros::Subscriber> subscribers_;
};

}  // namespace laparoscope_servo::screen
