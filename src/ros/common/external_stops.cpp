#include "ros/common/external_stops.h"

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <ros/console.h>
#include <ros/master.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>

#include "ros/common/stop_request.h"
#include "ros/common/unblocked_output.h"

namespace laparoscope_servo {

using diagnostic_msgs::DiagnosticStatus;

void describe(parameters::Table& table, ExternalStopsConfig& config) {
  table.group("master", "of ROS; services cannot be called without it, so the arm stops until it answers again",
              [&] { describe(table, config.master); });
  table.group("stop_line", "a contact outside of ROS; if it opens, or its wire breaks, the arm stops",
              [&] { describe(table, config.stop_line); });
}

ExternalStops::ExternalStops(const ExternalStopsConfig& config)
    : hold_(config.master.hold),
      stop_line_(config.stop_line),
      master_(config.master, ros::master::getHost(), ros::master::getPort(), ros::this_node::getName(),
              ros::XMLRPCManager::instance()->getServerURI()) {}

std::string ExternalStops::takeStop(double now) {
  followMaster();
  std::string stop;
  if (takeHaltRequest()) stop = "stopped by the signal SIGUSR1";
  const std::uint64_t stops = stop_line_.stops();
  const std::string problem = stop_line_.obstacle(now);
  // A pulse that is over already, or a line that has just changed to stop.
  if (stops != line_stops_ || (!problem.empty() && line_problem_.empty()))
    stop = problem.empty() ? stop_line_.lastStop() : problem;
  if (problem.empty() && !line_problem_.empty()) ROS_INFO("the stop line lets the arm move again");
  line_stops_ = stops;
  line_problem_ = problem;
  if (!stop.empty()) ROS_WARN_STREAM(stop);
  return stop;
}

void ExternalStops::followMaster() {
  const MasterStatus status = master_.status();
  if (status.state != master_status_.state) {
    if (status.state == MasterStatus::State::kKnown) {
      ROS_WARN_STREAM("the ROS master answers again, and knows this node");
    } else {
      ROS_ERROR_STREAM(status.reason << "; the arm is held");
    }
  }
  master_status_ = status;
}

bool ExternalStops::masterIsLate(double now) const {
  return master_status_.asked_at > 0.0 && now - master_status_.asked_at > hold_;
}

std::string ExternalStops::obstacle(double now) const {
  const std::string line = stop_line_.obstacle(now);
  return line.empty() ? masterProblem() : line;
}

void ExternalStops::describe(double now, diagnostic_updater::DiagnosticStatusWrapper& status) const {
  if (!masterProblem().empty()) status.mergeSummary(DiagnosticStatus::ERROR, masterProblem());
  status.add("ROS master", name(master_status_.state));
  status.add("answer of the ROS master [s]", master_status_.answer_time);
  status.add("answer of the ROS master, longest [s]", master_status_.longest);
  const std::string problem = stop_line_.obstacle(now);
  if (!problem.empty()) status.mergeSummary(DiagnosticStatus::WARN, problem);
  status.add("stop line", !stop_line_.isThere() ? "none" : problem.empty() ? "lets the arm move" : problem);
  status.add("stops by the stop line", stop_line_.stops());
  status.add("lines of the log that were dropped", droppedLogLines());
}

}  // namespace laparoscope_servo
