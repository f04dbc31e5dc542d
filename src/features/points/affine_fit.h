// Compares a point with its first view: an affine motion, gain and offset of the light (Marchand and Chaumette 2004,
// II.C.1, eq. (1)), by efficient second-order minimisation with Tukey's weights.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "features/points/point_image.h"
#include "features/points/window.h"
#include "laparoscope_servo/features/feature_state.h"
#include "laparoscope_servo/features/points.h"

namespace laparoscope_servo::features {

// Where a first view is in an image, and in which light.
struct PointPose {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();      // px
  Eigen::Matrix2d shape = Eigen::Matrix2d::Identity();  // takes px around the point in the first view to px around it
  double gain = 1.0;                                    // gain x image + offset looks like the first view
  double offset = 0.0;                                  // grey levels

  // Ratio of lengths, now to the first view; not finite where the shape is mirrored or flat.
  double scale() const;
};

// What is kept of a point's first view: windows of equal size on levels that are each half as fine as the one before,
// so that it can be compared with an image that is.
class PointView {
 public:
  static constexpr int kLevels = 3;
  // True if the window at the finest level is valid as a whole.
  bool take(const PointImage& picture, const Eigen::Vector2d& place, int half);
  const Eigen::Vector2d& place() const { return place_; }
  const Window& window(int l) const { return windows_[static_cast<std::size_t>(l)]; }

 private:
  Eigen::Vector2d place_ = Eigen::Vector2d::Zero();
  std::array<Window, kLevels> windows_;
};

struct AffineFit {
  // kNone: they are alike; kOutside, kCovered, kNotSeen, kShape, kUncertain: why that is not known.
  Reason reason = Reason::kNotSeen;
  PointPose pose;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // px^2 of the image, of the place
  double expected_error = 0.0;                           // px, standard deviation along its worst axis
  double correlation = 0.0;                              // -1 to 1, of what agrees
  double share = 0.0;                                    // of the window's textured cells that agree
};

class AffineFitter {
 public:
  explicit AffineFitter(const PointsConfig& config);

  // Starts from `start`, a few pixels off at most. Does not allocate.
  const AffineFit& fit(const PointView& view, const PointImage& image, const PointPose& start);

 private:
  static constexpr int kUnknowns = 8;
  using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;

  bool iterate(const Window& view, const PointImage& image, int view_level, int image_level, const PointPose& start);
  void compare(const Window& view);
  void weigh();
  void sum();
  void judge(const Window& view, const PointImage& image, int view_level, int image_level, const PointPose& start);

  PointsConfig config_;
  Window now_;
  std::array<std::vector<float>, kUnknowns> jacobian_;
  std::vector<double> unsmoothed_;  // of each level: variance of white noise whose sums over windows are as large
  std::vector<float> residuals_, weights_, weighted_, scratch_;
  double sigma_ = 0.0;  // grey levels, robust standard deviation of the residuals
  Normal normal_ = Normal::Zero();
  Vector right_ = Vector::Zero();
  AffineFit fit_;
};

}  // namespace laparoscope_servo::features
