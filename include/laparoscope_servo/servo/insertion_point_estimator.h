// Estimates the insertion point from poses of the shaft that passes through it.
//
// Every pose gives a line: a point p [m] and a unit direction a, pointing into the body, in the robot's base frame. The
// point c closest to all lines solves [sum w (I - aa')] c = sum w (I - aa') p. Noise of the directions makes I - aa'
// larger along the shaft than it is, by 2 sigma² aa' in the mean, and pulls c towards p; this bias is subtracted. The
// weights w are those of Tukey (C = 4.6851, scale from the median distance) over the variance of the distance between
// line and point: noise of the pose, breathing, and drift since the sample.
//
// The place along the shaft is observable only when the shaft turns. The number of samples of about the same direction
// is therefore limited, so that standing still does not reduce the covariance, and `observable` is true only if the
// directions differ enough. The calibration is a prior, which decides where the poses hold no information.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/servo/insertion_point_config.h"
#include "laparoscope_servo/servo/residual_level.h"

namespace laparoscope_servo::servo {

struct InsertionPointPrior {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // m, base frame
  double stddev = 0.01;                             // m, > 0, per axis
};

// The line of a shaft, in the base frame.
struct Shaft {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       // m
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  // unit, into the body
};

struct InsertionPointEstimate {
  bool valid = false;       // there is a prior, or the poses were enough
  bool observable = false;  // true: the poses determine the place along the shaft; false: only the prior does
  Eigen::Vector3d point = Eigen::Vector3d::Zero();           // m, base frame
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  // m²
  double smallest_eigenvalue = 0.0;                          // smallest eigenvalue of the mean of I - aa'
};

class InsertionPointEstimator {
 public:
  // Throws std::invalid_argument with all errors when the configuration or the prior is not valid.
  explicit InsertionPointEstimator(const InsertionPointConfig& config,
                                   const std::optional<InsertionPointPrior>& prior = std::nullopt);

  // Adds a pose at `time` [s]. Returns false, without any effect, if a number is not finite or the direction's length
  // is not 1 within 1 %. If time goes back, all poses are forgotten first.
  bool update(double time, const Shaft& shaft);

  // Forgets all poses, not the prior.
  void reset();

  const InsertionPointEstimate& estimate() const { return estimate_; }

  // m, root mean square distance of the last shafts from the point, computed from their median so that single wrong
  // poses do not matter.
  double residual() const { return residual_; }
  ResidualLevel residualLevel() const { return level_; }

 private:
  struct Sample {
    double time = 0.0;
    Shaft shaft;
    double distance = 0.0;  // m, distance of the line from the estimate
    double variance = 0.0;  // m², expected variance of each of the distance's two components
  };

  void insert(const Sample& sample);
  double measureSamples();
  void solve(double scale);
  void updateResidual(const Sample& sample);

  InsertionPointConfig config_;
  std::optional<InsertionPointPrior> prior_;
  std::vector<Sample> samples_;
  std::vector<Sample> recent_;  // ring buffer
  std::size_t next_recent_ = 0;
  std::vector<double> scratch_;
  double time_ = 0.0;
  InsertionPointEstimate estimate_;
  double residual_ = 0.0;
  ResidualLevel level_ = ResidualLevel::kOk;
};

// Depth and offset of a shaft's pose relative to the insertion point.
struct ShaftDepth {
  double d2 = 0.0;              // m, along the shaft from the insertion point to the camera centre
  double d1 = 0.0;              // m, from the end-effector's origin to the insertion point: length - d2
  double lateral_offset = 0.0;  // m, distance of the insertion point from the shaft
  double stddev = 0.0;          // m, of d1 and d2
};

// `camera` is the shaft's line with the camera centre for its point; `length` [m] is l = d1 + d2.
ShaftDepth shaftDepth(const InsertionPointEstimate& estimate, const Shaft& camera, double length);

// d1 [m] from twists (v [m/s], w [rad/s]) of the end-effector at O_7, in axes parallel to the camera's (0° optics, or
// the shaft's frame), for a fixed insertion point: eq. (12) solved for d1, least squares over all twists. Empty if the
// shaft turned by less than `min_turn` [rad/s], root of the sum of squares.
std::optional<double> d1FromVelocities(const std::vector<geometry::Vector6d>& twists, double min_turn = 0.01);

}  // namespace laparoscope_servo::servo
