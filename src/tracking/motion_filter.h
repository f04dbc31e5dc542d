// Predicts the homography in the next image: a Kalman filter on SL(3) whose measurements are ESM's estimates.
//
// State: G and its velocity. G is predicted by the last motion, damped, and believed with the covariance of the last
// estimate plus that of the innovations, which is learned: how far well-seen estimates were from their predictions, and
// in which directions. Corners of an ROI mostly move together; so when one half is covered, its motion is predicted
// from that of the other half, and directions that no pixel determines stay uncertain. Deviations x of G from an
// expected G are those of MotionPrior, in normalised template units.
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

  // The reference: G is the identity, exactly. `normalisation`: N of Esm, which must be that of `roi`.
  void start(const geometry::Rectangle& roi, const Eigen::Matrix3d& normalisation, double stamp);

  // G at `stamp` [s], and how sure that is. `carried`: the last estimate, moved by what somebody else knows of the
  // motion since; what remained beside that then goes on, instead of the whole motion.
  MotionPrior predict(double stamp, const std::optional<Eigen::Matrix3d>& carried = std::nullopt) const;

  // An estimate that is believed, of the image at `stamp`, found from `prior`. `learn`: so much is seen of the ROI that
  // its deviation tells how the target moves. `carried`: as it was given for the prediction.
  void update(const MotionPrior& prior, const EsmResult& estimate, double stamp, bool learn,
              const std::optional<Eigen::Matrix3d>& carried = std::nullopt);
  // The ROI has been found again: G is known afresh, its velocity is not.
  void restart(const EsmResult& estimate, double stamp);
  // The ROI was not seen: it is no longer expected to go on moving.
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
  geometry::Vector8d rest_ = geometry::Vector8d::Zero();      // 1/s, of what remained beside a motion that was given
  Matrix8d covariance_ = Matrix8d::Zero();                    // of last_
  Matrix8d innovation_ = Matrix8d::Zero();                    // covariance of deviations from predictions
  Matrix8d least_ = Matrix8d::Zero();                         // that innovation_ is never believed to be below
  double noise_ = 0.0;                                        // grey levels squared, see EsmResult
  double interval_ = 0.0;                                     // s, between images
  int learned_ = 0;
};

}  // namespace laparoscope_servo::tracking
