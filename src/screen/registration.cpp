#include "screen/registration.h"

#include <XmlRpcClient.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/publication.h>
#include <ros/this_node.h>
#include <ros/topic_manager.h>
#include <ros/xmlrpc_manager.h>

namespace laparoscope_servo::screen {

namespace {

constexpr double kPatience = 0.5;  // s

// The master's answer: a code (1: done), a message, a value.
bool isDone(XmlRpc::XmlRpcValue& answer) {
  return answer.getType() == XmlRpc::XmlRpcValue::TypeArray && answer.size() == 3 &&
         answer[0].getType() == XmlRpc::XmlRpcValue::TypeInt && static_cast<int>(answer[0]) == 1;
}

std::string here() {
  return ros::XMLRPCManager::instance()->getServerURI();
}

// Calls the function that the master calls for a new publisher; roscpp has no other access to it.
void tellPublishers(const std::string& topic, XmlRpc::XmlRpcValue& publishers) {
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(here(), host, port)) return;
  XmlRpc::XmlRpcClient self(host.c_str(), static_cast<int>(port), "/");
  XmlRpc::XmlRpcValue arguments, answer;
  arguments[0] = std::string("/master");
  arguments[1] = topic;
  arguments[2] = publishers;
  self.execute("publisherUpdate", arguments, answer);
}

}  // namespace

Registration::Registration() : client_(ros::master::getHost(), ros::master::getPort()) {}

bool Registration::renew(const std::atomic<bool>& ending) {
  const int now = process(ending);
  if (now == 0 || now == process_) return false;
  const bool first = process_ == 0;
  if (!first && isTaken(ending)) return false;
  process_ = now;
  if (first) return false;
  publishers(ending);
  subscribers(ending);
  return true;
}

// Process id of the master; 0 if it does not answer.
int Registration::process(const std::atomic<bool>& ending) {
  XmlRpc::XmlRpcValue answer;
  const auto outcome = client_.call("getPid", {ros::this_node::getName()}, kPatience, ending, answer);
  if (outcome != MasterClient::Outcome::kAnswered || !isDone(answer)) return 0;
  return answer[2].getType() == XmlRpc::XmlRpcValue::TypeInt ? static_cast<int>(answer[2]) : 0;
}

// Whether another process has taken this name; registering again would make the master end that one.
bool Registration::isTaken(const std::atomic<bool>& ending) {
  XmlRpc::XmlRpcValue answer;
  const std::string& name = ros::this_node::getName();
  const auto outcome = client_.call("lookupNode", {name, name}, kPatience, ending, answer);
  if (outcome != MasterClient::Outcome::kAnswered || !isDone(answer)) return false;
  return answer[2].getType() == XmlRpc::XmlRpcValue::TypeString && static_cast<std::string>(answer[2]) != here();
}

void Registration::publishers(const std::atomic<bool>& ending) {
  std::vector<std::string> topics;
  ros::this_node::getAdvertisedTopics(topics);
  for (const std::string& topic : topics) {
    const ros::PublicationPtr publication = ros::TopicManager::instance()->lookupPublication(topic);
    if (!publication) continue;
    XmlRpc::XmlRpcValue answer;
    client_.call("registerPublisher", {ros::this_node::getName(), topic, publication->getDataType(), here()}, kPatience,
                 ending, answer);
  }
}

void Registration::subscribers(const std::atomic<bool>& ending) {
  std::vector<std::string> topics;
  ros::this_node::getSubscribedTopics(topics);
  for (const std::string& topic : topics) {
    XmlRpc::XmlRpcValue answer;
    const auto outcome =
        client_.call("registerSubscriber", {ros::this_node::getName(), topic, "*", here()}, kPatience, ending, answer);
    if (outcome != MasterClient::Outcome::kAnswered || !isDone(answer)) continue;
    // Existing connections stay open until the master reports other publishers.
    if (answer[2].getType() == XmlRpc::XmlRpcValue::TypeArray && answer[2].size() > 0) tellPublishers(topic, answer[2]);
  }
}

}  // namespace laparoscope_servo::screen
