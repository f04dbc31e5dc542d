// The arm's own delay as it shows on the line: from a velocity, or the end of one, that is sent, to the statuses that
// show it. A step is needed: in servo control, which changes its command all the time, the controller node estimates
// the delay from the whole course of commands and velocities (servo/delay_estimator.h).
//
// Pure: `now` is seconds of a steady clock. Statuses are 25 ms apart, so a single delay is as coarse as that.
#pragma once

#include <optional>
#include <vector>

#include "laparoscope_servo/aesop/messages.h"

namespace laparoscope_servo::aesop {

class MotionDelay {
 public:
  // What has been sent: m/s or rad/s of every joint, zero when the arm shall stand.
  void sent(const JointVector& velocity, double now);
  void received(const Status& status, double now);
  // The link is lost: what is under way will not be seen.
  void lost();

  // Medians of the last ones; none before the first.
  std::optional<double> start() const { return median(starts_); }        // s, to half the speed
  std::optional<double> stop() const { return median(stops_); }          // s, to half the speed
  std::optional<double> standing() const { return median(standings_); }  // s, to the status that nothing moves

 private:
  enum class Phase { kNone, kStarting, kStopping };
  using Samples = std::vector<double>;

  void begin(Phase phase, const JointVector& velocity, double now);
  static void add(Samples& samples, double value);
  static std::optional<double> median(const Samples& samples);

  Phase phase_ = Phase::kNone;
  Eigen::Index joint_ = 0;  // that moves most
  double speed_ = 0.0;      // of that joint, signed: as sent when it starts, as measured when it stops
  double since_ = 0.0;      // s
  bool half_ = false;       // half the speed has been passed
  bool still_ = false;      // the last status: nothing moves
  JointVector sent_ = JointVector::Zero();
  JointVector measured_ = JointVector::Zero();
  Samples starts_;
  Samples stops_;
  Samples standings_;
};

}  // namespace laparoscope_servo::aesop
