#include "laparoscope_servo/aesop/motion_monitor.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::aesop {

namespace {

constexpr double kLeastShare = 0.1;       // share of the commanded displacement, below which the joint does not move
constexpr double kLargestShare = 1.5;     // share of the commanded displacement, above which the joint runs away
constexpr double kSettled = 1.8;          // response times without a command after which the joint must be at rest
constexpr double kDifferentShare = 0.25;  // share of a displacement by which positions and velocities may disagree

}  // namespace

void describe(parameters::Table& table, MonitorConfig& c) {
  table.number("response_time", c.response_time, {0.2, 10}, "s",
               "time over which motion and commands are compared; well above the arm's delay");
  table.number("slowest_angle", c.slowest_angle, {1e-4, 1}, "rad/s",
               "slower commands may cause no motion because of friction");
  table.number("slowest_distance", c.slowest_distance, {1e-4, 1}, "m/s",
               "slower commands may cause no motion because of friction");
  table.number("tolerance_angle", c.tolerance_angle, {1e-4, 1}, "rad",
               "allowed motion without a command, and allowed difference between positions and integrated velocities");
  table.number("tolerance_distance", c.tolerance_distance, {1e-4, 1}, "m",
               "allowed motion without a command, and allowed difference between positions and integrated velocities");
}

std::vector<std::string> validate(const MonitorConfig& config) {
  return parameters::errorsOf(config);
}

MotionMonitor::MotionMonitor(const MonitorConfig& config, const Kinematics& kinematics) : config_(config) {
  for (const int index : kinematics.driven()) {
    joints_.push_back({index + 1, index, kinematics.config().joints[static_cast<std::size_t>(index)].prismatic});
  }
}

std::string MotionMonitor::take(const Status& status, const std::array<double, kDrivenJoints>& speed, double now) {
  Sample sample{now, status.time, status.position, status.velocity, JointVector::Zero(), speed};
  if (!samples_.empty()) {
    const Sample& last = samples_.back();
    // Uses the controller's clock, so that statuses that arrive late together do not look like jumps.
    sample.travelled = last.travelled + 0.5 * (status.time - last.controller_time) * (last.velocity + status.velocity);
  }
  samples_.push_back(sample);
  while (samples_.front().at < now - 2.0 * config_.response_time) samples_.pop_front();
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    std::string reason = judge(k);
    if (reason.empty()) reason = judgeRest(k);
    if (!reason.empty()) return "joint " + std::to_string(joints_[k].number) + reason;
  }
  return "";
}

// Detects creeping motion, which is too slow for the other checks.
std::string MotionMonitor::judgeRest(std::size_t driven) {
  const Joint& joint = joints_[driven];
  const bool commanded =
      std::any_of(samples_.begin(), samples_.end(), [&](const Sample& s) { return s.speed[driven] != 0.0; });
  if (commanded || samples_.back().at - samples_.front().at < kSettled * config_.response_time) {
    if (commanded) rest_[driven].reset();
    return "";
  }
  const double position = samples_.back().position[joint.index];
  if (!rest_[driven]) rest_[driven] = position;
  const double tolerance = joint.prismatic ? config_.tolerance_distance : config_.tolerance_angle;
  if (std::abs(position - *rest_[driven]) <= tolerance) return "";
  std::ostringstream text;
  text << " has crept by " << position - *rest_[driven] << (joint.prismatic ? " m" : " rad")
       << ", which nobody has commanded";
  return text.str();
}

std::size_t MotionMonitor::windowStart() const {
  const double begin = samples_.back().at - config_.response_time;
  const auto first = std::find_if(samples_.begin(), samples_.end(), [&](const Sample& s) { return s.at >= begin; });
  return static_cast<std::size_t>(first - samples_.begin());
}

std::string MotionMonitor::judge(std::size_t driven) const {
  const Joint& joint = joints_[driven];
  const double tolerance = joint.prismatic ? config_.tolerance_distance : config_.tolerance_angle;
  const double slowest = joint.prismatic ? config_.slowest_distance : config_.slowest_angle;
  const std::size_t begin = windowStart();
  const Sample& first = samples_[begin];
  const Sample& last = samples_.back();
  const double moved = last.position[joint.index] - first.position[joint.index];
  const double travelled = last.travelled[joint.index] - first.travelled[joint.index];

  double fastest = 0.0;  // includes commands before the window, which still move the joint
  for (const Sample& sample : samples_) fastest = std::max(fastest, std::abs(sample.speed[driven]));
  std::ostringstream text;
  if (!(std::abs(moved) <= kLargestShare * config_.response_time * fastest + tolerance)) {
    text << " has moved by " << moved << (joint.prismatic ? " m" : " rad") << ", which nobody has commanded";
    return text.str();
  }
  if (begin == 0) return "";  // not enough samples yet
  if (!(std::abs(moved - travelled) <= tolerance + kDifferentShare * std::max(std::abs(moved), std::abs(travelled)))) {
    text << " contradicts itself: moved by " << moved << (joint.prismatic ? " m" : " rad") << ", by its velocities "
         << travelled;
    return text.str();
  }
  // The first sample's command was in force before the window.
  double commanded = 0.0;
  for (std::size_t k = begin + 1; k < samples_.size(); ++k) {
    if (std::abs(samples_[k].speed[driven]) < slowest) return "";
    if (samples_[k].speed[driven] * last.speed[driven] < 0.0) return "";
    commanded += samples_[k].speed[driven] * (samples_[k].at - samples_[k - 1].at);
  }
  if (commanded != 0.0 && moved * (commanded > 0.0 ? 1.0 : -1.0) < kLeastShare * std::abs(commanded)) {
    text << " does not follow: commanded by " << commanded << (joint.prismatic ? " m" : " rad") << ", moved by "
         << moved;
  }
  return text.str();
}

}  // namespace laparoscope_servo::aesop
