// Whether the joints do what they are told, by their own account: a motor that stands, a joint that runs away, a sensor
// that no longer tells the truth. The controller need not notice any of that.
//
// Pure: `now` is seconds of a steady clock.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/aesop/kinematics.h"
#include "laparoscope_servo/aesop/messages.h"

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::aesop {

// Defaults are those of config/aesop.yaml, group `monitor`.
struct MonitorConfig {
  double response_time = 1.0;  // s: what joints do is judged over so long; well above the arm's delay
  // Slower commands than these may move nothing: friction. rad/s and m/s, 1e-4 to 1
  double slowest_angle = 0.01;
  double slowest_distance = 0.002;
  // Motion that no command explains, and what positions and velocities may differ by, within response_time. rad and m,
  // 1e-4 to 1
  double tolerance_angle = 0.01;
  double tolerance_distance = 0.003;
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, MonitorConfig& config);

std::vector<std::string> validate(const MonitorConfig& config);

class MotionMonitor {
 public:
  MotionMonitor(const MonitorConfig& config, const Kinematics& kinematics);

  // To be called when the arm is enabled, or is no longer.
  void reset() {
    samples_.clear();
    rest_.fill(std::nullopt);
  }
  // `speed`: of the driven joints, as commanded since the status before. Says what is wrong; empty when nothing is.
  std::string take(const Status& status, const std::array<double, kDrivenJoints>& speed, double now);

 private:
  struct Joint {
    int number;  // 1 to 7
    int index;  // in a JointVector
    bool prismatic;
  };
  struct Sample {
    double at;
    double controller_time;
    JointVector position;
    JointVector velocity;
    JointVector travelled;  // by the velocities, since the first sample
    std::array<double, kDrivenJoints> speed;
  };
  std::string judge(std::size_t driven) const;
  std::string judgeRest(std::size_t driven);
  std::size_t windowStart() const;

  MonitorConfig config_;
  std::vector<Joint> joints_;
  std::deque<Sample> samples_;  // of the last two response times
  std::array<std::optional<double>, kDrivenJoints>
      rest_;  // where each joint has to stay until the next command, m or rad
};

}  // namespace laparoscope_servo::aesop
