// The motion that the robot reports: velocities at irregular times, some of which may be missing.
#pragma once

#include <Eigen/Core>
#include <deque>

#include "laparoscope_servo/scope/velocity.h"

namespace laparoscope_servo::servo {

class ReportedMotion {
 public:
  // Keeps the reports of the last `span` [s] > 0. A report is valid for `life` [s] > 0; between two reports that are no
  // further apart, the velocity is interpolated linearly.
  ReportedMotion(double span, double life) : span_(span), life_(life) {}

  // Adds the velocity at `time` [s], both finite. A time before the last one clears the history.
  void add(double time, const scope::Velocity& velocity);

  // (pan, tilt, spin [rad], insertion [m]) from `begin` to `end` [s]; zero where no report is valid.
  Eigen::Vector4d displacement(double begin, double end) const;

 private:
  struct Report {
    double time;
    Eigen::Vector4d velocity;
  };
  double span_;
  double life_;
  std::deque<Report> reports_;
};

}  // namespace laparoscope_servo::servo
