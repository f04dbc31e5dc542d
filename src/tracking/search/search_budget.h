// Time budget of the search in an image, counted by nominal costs.
#pragma once

namespace laparoscope_servo::tracking {

// Nominal costs of the pieces of the search, in seconds. They are used instead of a clock, so that the same images give
// the same results on every machine. bench_returns measures the true costs on a machine.
//
// Measured by bench_returns on one core (AMD EPYC, 2.6 GHz, OpenCV 4.6): per pixel, per point, per pair of points.
namespace nominal_cost {

constexpr double kPixelTaken = 1.5e-9;  // of the image, for making it coarse
// of the coarse image; SIFT doubles its size, and builds its pyramid twice (points, descriptors)
constexpr double kPixelDetected = 250e-9;
constexpr double kPointDescribed = 27e-6;  // a descriptor of 128 numbers
constexpr double kPairCompared = 25e-9;    // a point of the image with one of a view
constexpr double kMotionFitted = 1e-3;     // RANSAC, for one view
constexpr double kPixelSlidOver = 60e-9;   // of the coarse image of the template search
constexpr double kStartChecked = 0.6e-3;   // see StartCheck
constexpr double kPixelLookedAt = 60e-9;   // of the finest level, by an alignment before its first iteration
constexpr double kPixelIterated = 5e-9;    // of the finest level, for an iteration, with the coarse levels

}  // namespace nominal_cost

class SearchBudget {
 public:
  // Starts a new image with this budget [s].
  void start(double seconds) {
    left_ = seconds;
    idle_ = true;
  }
  // Returns whether a piece of this cost may be done, and if so subtracts the cost. The first piece of an image is
  // always allowed, so that the search goes on however expensive a piece is.
  bool pay(double cost) {
    if (!idle_ && cost > left_) return false;
    idle_ = false;
    left_ -= cost;
    return true;
  }
  // Like pay(), for a cheap piece, which does not count as the first one.
  bool payCheap(double cost) {
    if (cost > left_) return false;
    left_ -= cost;
    return true;
  }

  // Corrects the cost of a piece that was paid for.
  void charge(double more) { left_ -= more; }

 private:
  double left_ = 0.0;  // s
  bool idle_ = true;   // no piece was done yet
};

}  // namespace laparoscope_servo::tracking
