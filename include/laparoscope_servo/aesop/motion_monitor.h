// Checks by the reported joint positions and velocities whether the joints execute their commands. Detects a motor that
// does not move, a joint that runs away, and a faulty sensor, which the arm's controller may not notice.
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
  double response_time = 1.0;  // s: time over which motion is compared; well above the arm's delay
  // Slower commands may cause no motion because of friction. rad/s and m/s, 1e-4 to 1
  double slowest_angle = 0.01;
  double slowest_distance = 0.002;
  // Allowed motion without a command, and allowed difference between positions and integrated velocities, within
  // response_time. rad and m, 1e-4 to 1
  double tolerance_angle = 0.01;
  double tolerance_distance = 0.003;
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, MonitorConfig& config);

std::vector<std::string> validate(const MonitorConfig& config);

class MotionMonitor {
 public:
  MotionMonitor(const MonitorConfig& config, const Kinematics& kinematics);

  // Call when the arm is enabled, and when it no longer is.
  void reset() {
    samples_.clear();
    rest_.fill(std::nullopt);
  }
  // `speed`: velocities of the driven joints, as commanded since the last status. Returns what is wrong, or an empty
  // text.
  std::string take(const Status& status, const std::array<double, kDrivenJoints>& speed, double now);

 private:
  struct Joint {
    int number;  // 1 to 7
    int index;   // in a JointVector
    bool prismatic;
  };
  struct Sample {
    double at;
    double controller_time;
    JointVector position;
    JointVector velocity;
    JointVector travelled;  // integral of the velocities since the first sample
    std::array<double, kDrivenJoints> speed;
  };
  std::string judge(std::size_t driven) const;
  std::string judgeRest(std::size_t driven);
  std::size_t windowStart() const;

  MonitorConfig config_;
  std::vector<Joint> joints_;
  std::deque<Sample> samples_;  // samples of the last two response times
  std::array<std::optional<double>, kDrivenJoints>
      rest_;  // m or rad, position that each joint must keep until the next command
};

}  // namespace laparoscope_servo::aesop
