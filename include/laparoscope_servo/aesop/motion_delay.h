// Measures the arm's own delay on the line: from sending a velocity, or its end, to the statuses that show it. It needs
// a step of the command. In servo control, where the command changes all the time, the controller node estimates the
// delay from the history of commands and velocities (servo/prediction/delay_estimator.h).
//
// Pure: `now` is seconds of a steady clock. Statuses are 25 ms apart, which is the resolution of a single delay.
#pragma once

#include <optional>
#include <vector>

#include "laparoscope_servo/aesop/messages.h"

namespace laparoscope_servo::aesop {

class MotionDelay {
 public:
  // Takes the velocity sent: m/s or rad/s of every joint, zero to stop.
  void sent(const JointVector& velocity, double now);
  void received(const Status& status, double now);
  // The link is lost: ends a measurement that is under way.
  void lost();

  // Medians of the last measurements; empty before the first.
  std::optional<double> start() const { return median(starts_); }        // s, to half the speed
  std::optional<double> stop() const { return median(stops_); }          // s, to half the speed
  std::optional<double> standing() const { return median(standings_); }  // s, to the status that reports rest

 private:
  enum class Phase { kNone, kStarting, kStopping };
  using Samples = std::vector<double>;

  void begin(Phase phase, const JointVector& velocity, double now);
  static void add(Samples& samples, double value);
  static std::optional<double> median(const Samples& samples);

  Phase phase_ = Phase::kNone;
  Eigen::Index joint_ = 0;  // the joint that moves most
  double speed_ = 0.0;      // signed speed of that joint: as sent when it starts, as measured when it stops
  double since_ = 0.0;      // s
  bool half_ = false;       // half the speed has been passed
  bool still_ = false;      // the last status reports rest
  JointVector sent_ = JointVector::Zero();
  JointVector measured_ = JointVector::Zero();
  Samples starts_;
  Samples stops_;
  Samples standings_;
};

}  // namespace laparoscope_servo::aesop
