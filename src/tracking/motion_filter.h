// Predicts the homography in the next image: a Kalman filter on SL(3) whose measurements are ESM's estimates.
//
// State: G and its velocity. G is predicted by the damped last motion. Its covariance is that of the last estimate plus
// the innovation covariance, which is estimated online from the deviations of well-visible estimates from their
// predictions. Since the corners of an ROI mostly move together, a covered half is predicted from the motion of the
// other half; directions that no pixel determines stay uncertain. Deviations x of G from an expected G are those of
// MotionPrior, in normalised template units.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/geometry/sl3.h"
#include "tracking/esm/esm.h"

namespace laparoscope_servo::tracking {

class MotionFilter {
 public:
  // `damping`, 0 to 1: share of the last motion that is expected to go on.
  explicit MotionFilter(double damping) : damping_(damping) {}
  void setDamping(double damping) { damping_ = damping; }

  // Starts at the reference, where G is exactly the identity. `normalisation`: N of Esm, which must be that of `roi`.
  void start(const geometry::Rectangle& roi, const Eigen::Matrix3d& normalisation, double stamp);

  // Predicts G at `stamp` [s], with its covariance. `carried`: the last estimate moved by the ego-motion since; only
  // the motion that remained beside the ego-motion is then predicted to go on.
  MotionPrior predict(double stamp, const std::optional<Eigen::Matrix3d>& carried = std::nullopt) const;

  // Takes an accepted estimate of the image at `stamp`, found with `prior`. `learn`: enough of the ROI is visible for
  // the deviation to update the innovation covariance. `carried`: as passed to predict().
  void update(const MotionPrior& prior, const EsmResult& estimate, double stamp, bool learn,
              const std::optional<Eigen::Matrix3d>& carried = std::nullopt);
  // Starts again from an estimate after a loss; the velocity is unknown.
  void restart(const EsmResult& estimate, double stamp);
  // The ROI was not found: the velocity is set to zero.
  void stop() {
    velocity_.setZero();
    rest_.setZero();
  }

  const Eigen::Matrix3d& last() const { return last_; }
  double lastStamp() const { return last_stamp_; }

 private:
  geometry::Vector8d deviation(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) const;

  double damping_;
  geometry::Rectangle roi_;
  geometry::Sl3Steps steps_;
  Eigen::Matrix3d last_ = Eigen::Matrix3d::Identity();
  double last_stamp_ = 0.0;
  geometry::Vector8d velocity_ = geometry::Vector8d::Zero();  // 1/s
  geometry::Vector8d rest_ = geometry::Vector8d::Zero();      // 1/s, of the motion that remained beside the ego-motion
  Matrix8d covariance_ = Matrix8d::Zero();                    // covariance of last_
  Matrix8d innovation_ = Matrix8d::Zero();                    // covariance of deviations from predictions
  Matrix8d least_ = Matrix8d::Zero();                         // added to innovation_, as its least value
  double noise_ = 0.0;                                        // grey levels squared, see EsmResult
  double interval_ = 0.0;                                     // s, between images
  int learned_ = 0;
};

}  // namespace laparoscope_servo::tracking
