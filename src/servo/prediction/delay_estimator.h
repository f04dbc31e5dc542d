// Estimates how long the robot takes to execute a command, from the commands sent and the velocities it reports.
//
// The reports of a sliding window are correlated with the commands of a delay earlier, over all delays between two
// bounds: means taken off, axes weighted by their smallest excitation, the peak refined by a parabola. The curvature at
// the peak, relative to the uncorrelated part, gives the standard deviation. A command is held until the next one; a
// known lag of first order is applied to the commands, so that what remains is delay. Without a known lag, the delay
// contains it.
//
// A comparison is used when an axis was excited, the correlation is high, its peak lies between the bounds and is
// sharp. If not, the estimate stays as it is. It never leaves the bounds, and its rate of change is limited.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <vector>

#include "servo/prediction/delay_config.h"

namespace laparoscope_servo::servo {

class DelayEstimator {
 public:
  // Throws std::invalid_argument with all errors when the configuration is not valid.
  explicit DelayEstimator(const DelayConfig& config);

  // Take a command sent at `time` [s], and a velocity reported for `time` [s], on the same clock. Both return false,
  // without any effect, if a number is not finite. If time goes back, or after a gap, the window is cleared, but not
  // the estimate.
  bool command(double time, const scope::Velocity& velocity);
  bool report(double time, const scope::Velocity& velocity);

  // s, within the bounds of the configuration.
  double delay() const { return delay_; }

  // Whether the last comparison is good enough to be used.
  bool informative() const { return informative_; }

  // Correlation (0 to 1) and standard deviation [s] of the last comparison. The correlation is 0 if there was none.
  double correlation() const { return correlation_; }
  double stddev() const { return stddev_; }

  // Clears the window, and with `also_delay` also the estimate.
  void reset(bool also_delay);

 private:
  struct Sample {
    double time;
    Eigen::Vector4d velocity;
  };
  struct Peak {
    bool usable = false;
    double delay = 0.0;
  };

  bool admit(std::deque<Sample>& samples, double time, const scope::Velocity& velocity);
  void compare();
  void resampleCommands();
  Eigen::Vector4d commandAt(double time) const;
  double correlationAt(double delay) const;
  Peak findPeak();

  DelayConfig config_;
  std::deque<Sample> commands_;
  std::deque<Sample> reports_;
  double grid_start_ = 0.0;
  std::vector<Eigen::Vector4d> grid_;  // commands as they would be executed without delay
  std::vector<double> correlations_;
  Eigen::Vector4d weights_ = Eigen::Vector4d::Zero();  // weights of the axes, 0: not used
  double next_comparison_ = 0.0;
  double delay_ = 0.0;
  bool informative_ = false;
  double correlation_ = 0.0;
  double stddev_ = 0.0;
};

}  // namespace laparoscope_servo::servo
