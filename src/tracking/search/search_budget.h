// The time that is left for the search in an image, counted by the nominal costs of its pieces.
#pragma once

namespace laparoscope_servo::tracking {

// What pieces of the search cost, in seconds. The search spends its budget by these figures instead of by a clock, so
// that the same images give the same numbers on every machine; how far they hold on yours, bench_returns says.
//
// Measured by bench_returns on one core (AMD EPYC, 2.6 GHz, OpenCV 4.6): per pixel, per point, per pair of points.
namespace nominal_cost {

constexpr double kPixelTaken = 1.5e-9;     // of the image, made coarse
constexpr double kPixelDetected = 250e-9;  // of the coarse image: SIFT looks at it twice as fine, and twice
constexpr double kPointDescribed = 27e-6;  // 128 numbers
constexpr double kPairCompared = 25e-9;    // a point of the image with one of a view
constexpr double kMotionFitted = 1e-3;     // RANSAC, for one view
constexpr double kPixelSlidOver = 60e-9;   // of the image that the region is slid over
constexpr double kStartChecked = 0.6e-3;   // see StartCheck
constexpr double kPixelLookedAt = 60e-9;   // of the ROI, by an alignment before its first iteration
constexpr double kPixelIterated = 5e-9;    // of the ROI, by an iteration, the coarse levels among them

}  // namespace nominal_cost

class SearchBudget {
 public:
  // A new image, with so many seconds.
  void start(double seconds) {
    left_ = seconds;
    idle_ = true;
  }
  // Whether a piece that costs so much may be done, which is then paid for. The first one of an image always may: the
  // search goes on, however dear a piece is.
  bool pay(double cost) {
    if (!idle_ && cost > left_) return false;
    idle_ = false;
    left_ -= cost;
    return true;
  }
  // Likewise, for a piece so cheap that it does not use up the right of the first one.
  bool payCheap(double cost) {
    if (cost > left_) return false;
    left_ -= cost;
    return true;
  }

  // A piece that was paid for has cost so much more, or less.
  void charge(double more) { left_ -= more; }

 private:
  double left_ = 0.0;  // s
  bool idle_ = true;   // nothing was done yet
};

}  // namespace laparoscope_servo::tracking
