#include "screen/features/feature_link.h"

#include <ros/master.h>
#include <ros/this_node.h>

#include <algorithm>

#include "screen/listen.h"

namespace laparoscope_servo::screen {

namespace {

constexpr double kPatience = 0.5;          // s
constexpr std::uint32_t kQueue = 100;      // as that of the region tracker's results
constexpr std::size_t kMostTrackers = 16;  // more have no room on the screen
const std::string kTopic = "/features";

bool isText(XmlRpc::XmlRpcValue& value) {
  return value.getType() == XmlRpc::XmlRpcValue::TypeString;
}

bool isList(XmlRpc::XmlRpcValue& value, int size) {
  return value.getType() == XmlRpc::XmlRpcValue::TypeArray && value.size() == size;
}

}  // namespace

std::vector<std::string> featureTrackersIn(XmlRpc::XmlRpcValue answer, const std::string& space) {
  std::vector<std::string> names;
  if (!isList(answer, 3) || answer[2].getType() != XmlRpc::XmlRpcValue::TypeArray) return names;
  const std::string prefix = !space.empty() && space.back() == '/' ? space : space + "/";
  for (int k = 0; k < answer[2].size(); ++k) {
    XmlRpc::XmlRpcValue& entry = answer[2][k];
    if (!isList(entry, 2) || !isText(entry[0]) || !isText(entry[1])) continue;
    const std::string topic = entry[0], type = entry[1];
    if (type != ros::message_traits::datatype<TrackedFeatures>() || topic.size() <= prefix.size() + kTopic.size() ||
        topic.compare(0, prefix.size(), prefix) != 0 ||
        topic.compare(topic.size() - kTopic.size(), kTopic.size(), kTopic) != 0)
      continue;
    const std::string name = topic.substr(prefix.size(), topic.size() - prefix.size() - kTopic.size());
    if (name.find('/') == std::string::npos) names.push_back(name);  // else of another namespace
  }
  std::sort(names.begin(), names.end());
  return names;
}

FeatureLink::FeatureLink(const ros::NodeHandle& node, const Take& take)
    : node_(node), client_(ros::master::getHost(), ros::master::getPort()), take_(take) {}

void FeatureLink::find() {
  XmlRpc::XmlRpcValue answer;
  if (client_.call("getPublishedTopics", {ros::this_node::getName(), ""}, kPatience, ends_, answer) !=
      MasterClient::Outcome::kAnswered)
    return;
  for (const std::string& name : featureTrackersIn(answer, node_.getNamespace())) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (ends_ || subscribers_.count(name) > 0 || subscribers_.size() >= kMostTrackers) continue;
    }
    const ros::Subscriber subscriber = listen<TrackedFeatures>(
        node_, name + kTopic, kQueue, [this, name](const TrackedFeatures& message) { this->take(name, message); });
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!ends_) subscribers_[name] = subscriber;
  }
}

void FeatureLink::take(const std::string& tracker, const TrackedFeatures& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (take_) take_(tracker, message);
}

FeatureLink::Connected FeatureLink::connected() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  Connected all;
  for (const auto& [name, subscriber] : subscribers_) all.emplace_back(name, subscriber.getNumPublishers() > 0);
  return all;
}

void FeatureLink::close() {
  std::map<std::string, ros::Subscriber> subscribers;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
    take_ = nullptr;
    subscribers.swap(subscribers_);
  }
  // Without the lock: unsubscribing waits for callbacks, which take it.
}

}  // namespace laparoscope_servo::screen
