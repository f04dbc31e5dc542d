// Time budget of the search in an image, counted by nominal costs.
#pragma once

namespace laparoscope_servo::tracking {

// Nominal costs of the pieces of the search, in seconds. They are used instead of a clock, so that the same images give
// the same results on every machine. bench_returns measures the true costs on a machine.
//
// Measured by bench_returns on one core (AMD EPYC, 2.6 GHz, OpenCV 4.6): per pixel, per point, per pair of points.
namespace nominal_cost {

constexpr double kPixelTaken = 1.5e-9;  // of the image, for making it coarse; of a view and of a checked place, too
constexpr double kPixelMasked = 4e-9;   // of a view, for drawing what was covered there
// of the coarse image; SIFT doubles its size, and builds its pyramid twice (points, descriptors)
constexpr double kPixelDetected = 250e-9;
constexpr double kPointDescribed = 27e-6;  // a descriptor of 128 numbers
constexpr double kPairCompared = 25e-9;    // a point of the image with one of a view
constexpr double kMotionFitted = 1e-3;     // RANSAC, for one view
constexpr double kPixelSlidOver = 60e-9;   // of the coarse image of the template search
constexpr double kStartChecked = 0.6e-3;   // see StartCheck; besides the pixels taken
constexpr double kPixelBuilt = 2e-9;       // of the image, for the pyramid of an alignment; estimated
constexpr double kPixelLookedAt = 60e-9;   // of the finest level, by an alignment besides its iterations
constexpr double kPixelIterated = 5e-9;    // of a level, for an iteration

}  // namespace nominal_cost

class SearchBudget {
 public:
  // Starts a new image with this budget [s].
  void start(double seconds) {
    left_ = seconds;
    half_ = 0.5 * seconds;
    idle_ = true;
    cheap_ = 0;
  }
  // Returns whether a piece of this cost may be done, and if so subtracts the cost. The first piece of an image is
  // allowed however expensive it is, so that the search goes on, unless cheap ones took more than half of the budget:
  // then it is the first of the next image.
  bool pay(double cost) {
    const bool first = idle_ && (cheap_ <= 1 || left_ >= half_);
    if (!first && cost > left_) return false;
    idle_ = false;
    left_ -= cost;
    return true;
  }
  // Like pay(), for a cheap piece, which does not count as the first one.
  bool payCheap(double cost) {
    const bool first = idle_ && cheap_ == 0;
    if (!first && cost > left_) return false;
    ++cheap_;
    left_ -= cost;
    return true;
  }

  // Corrects the cost of a piece that was paid for.
  void charge(double more) { left_ -= more; }
  double left() const { return left_; }

 private:
  double left_ = 0.0;  // s
  double half_ = 0.0;  // s, of the image's budget
  bool idle_ = true;   // no piece was done yet but cheap ones
  int cheap_ = 0;      // cheap pieces that were done
};

}  // namespace laparoscope_servo::tracking
