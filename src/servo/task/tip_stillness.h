// Whether a hand holds an instrument's tip still. A scope that follows a tip at work would never come to rest, nor
// would the hand; and what the scope's own motion does to the picture shows best when nothing else moves in it.
#pragma once

#include <Eigen/Core>

namespace laparoscope_servo::servo {

class TipStillness {
 public:
  // `dwell` [s]: how long it has to be within `still` (normalised) of one place.
  TipStillness(double dwell, double still) : dwell_(dwell), still_(still) {}

  // Takes the tip (normalised) in an image of `time` [s], of a scope at rest. Time that goes back begins anew, and so
  // does a place that is not finite.
  void see(double time, const Eigen::Vector2d& tip);
  // Call while the scope moves, or where no tip is seen.
  void restart() { is_seen_ = false; }

  bool isStill() const { return is_seen_ && last_ - since_ >= dwell_; }

 private:
  double dwell_, still_;
  bool is_seen_ = false;
  double since_ = 0.0, last_ = 0.0;                  // s
  Eigen::Vector2d place_ = Eigen::Vector2d::Zero();  // where it was at since_
};

}  // namespace laparoscope_servo::servo
