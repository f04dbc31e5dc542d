#include "laparoscope_servo/ros/stop_request.h"

#include <XmlRpcValue.h>
#include <ros/xmlrpc_manager.h>

#include <csignal>

namespace laparoscope_servo::skin {

namespace {

volatile std::sig_atomic_t stop_requested = 0;

void onSignal(int) {
  stop_requested = 1;
}

// What `rosnode kill` calls, and the master when a second node takes this one's name.
void onShutdownCall(XmlRpc::XmlRpcValue&, XmlRpc::XmlRpcValue& result) {
  stop_requested = 1;
  result = ros::xmlrpc::responseInt(1, "", 0);
}

}  // namespace

void catchStopRequests() {
  std::signal(SIGINT, onSignal);
  std::signal(SIGTERM, onSignal);
  std::signal(SIGHUP, onSignal);
  ros::XMLRPCManager::instance()->unbind("shutdown");
  ros::XMLRPCManager::instance()->bind("shutdown", onShutdownCall);
}

bool stopRequested() {
  return stop_requested != 0;
}

}  // namespace laparoscope_servo::skin
