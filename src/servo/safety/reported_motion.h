// What the robot says that it does: its velocity at moments that need not be even, and some of them may be missing.
#pragma once

#include <Eigen/Core>
#include <deque>

#include "laparoscope_servo/scope/velocity.h"

namespace laparoscope_servo::servo {

class ReportedMotion {
 public:
  // Keeps the reports of the last `span` [s] > 0. A report stands for the motion for `life` [s] > 0; between two that
  // are no further apart, the velocity goes in a straight line from the one to the other.
  ReportedMotion(double span, double life) : span_(span), life_(life) {}

  // The robot's velocity at `time` [s], both finite. One that is older than the last makes it begin anew.
  void add(double time, const scope::Velocity& velocity);

  // (pan, tilt, spin [rad], insertion [m]) from `begin` to `end` [s]. Nothing where no report stands for it.
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
