#include "ros/common/stop_request.h"

#include <XmlRpcValue.h>
#include <ros/xmlrpc_manager.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "ros/common/quiet_thread.h"
#include "ros/common/unblocked_output.h"

namespace laparoscope_servo {

namespace {

constexpr std::chrono::milliseconds kFarewell{1500};  // for unregistering from the master

volatile std::sig_atomic_t stop_requested = 0;
volatile std::sig_atomic_t halt_requested = 0;

void onSignal(int) {
  stop_requested = 1;
}

void onHaltSignal(int) {
  halt_requested = 1;
}

// Called by `rosnode kill`, and by the master when a second node takes this one's name.
void onShutdownCall(XmlRpc::XmlRpcValue&, XmlRpc::XmlRpcValue& result) {
  stop_requested = 1;
  result = ros::xmlrpc::responseInt(1, "", 0);
}

}  // namespace

void catchStopRequests() {
  std::signal(SIGINT, onSignal);
  std::signal(SIGTERM, onSignal);
  std::signal(SIGHUP, onSignal);
  std::signal(SIGUSR1, onHaltSignal);
  ros::XMLRPCManager::instance()->unbind("shutdown");
  ros::XMLRPCManager::instance()->bind("shutdown", onShutdownCall);
}

bool stopRequested() {
  return stop_requested != 0;
}

bool takeHaltRequest() {
  const bool requested = halt_requested != 0;
  if (requested) halt_requested = 0;
  return requested;
}

void limitFarewell(int status) {
  startQuietThread([status] {
    std::this_thread::sleep_for(kFarewell);
    flushOutput();
    std::_Exit(status);
  }).detach();
}

}  // namespace laparoscope_servo
