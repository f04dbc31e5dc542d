// Estimates the motion from one image to another, and judges whether the estimate may be used.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "laparoscope_servo/features/feature_state.h"
#include "motion/motion_aligner.h"
#include "motion/motion_support.h"

namespace laparoscope_servo::motion {

struct MotionEstimate {
  features::Reason why = features::Reason::kNone;  // why it may not be used; kNone: it may, and all else is set
  Alignment at;
  tracking::Matrix8d covariance = tracking::Matrix8d::Zero();       // see MotionAligner::covariance()
  double usable = 0.0;                                              // see JointUse
  double share = 0.0;                                               // see MotionSupport
  double expected_error = std::numeric_limits<double>::infinity();  // px, at the worst corner of the region
};

// px, by which a comparison with an image of a while ago may be off what the steps since then have led to. `error`: px,
// expected of these. One that is further off found something else.
inline double mostSurprise(double error) {
  return 2.0 + 4.0 * error;
}

class MotionEstimator {
 public:
  // `shaded`: see MotionAligner.
  explicit MotionEstimator(const MotionConfig& config, bool shaded = false)
      : config_(config), aligner_(config, shaded) {
    again_.reserve(1);
  }

  void setReference(const MotionImage& image);
  // `region`: px of the reference image; `whole`: it is all of the image. `starts`: the expected motion first.
  const MotionEstimate& estimate(const MotionImage& reference, const MotionImage& current,
                                 const std::vector<Eigen::Matrix3d>& starts, const geometry::Quadrilateral& region,
                                 bool whole);
  // Forgets the expected scale of the residuals, and the support.
  void forget();

  const MotionSupport& support() const { return support_; }

 private:
  features::Reason judge(const MotionImage& reference, const MotionImage& current,
                         const std::vector<Eigen::Matrix3d>& starts, const geometry::Quadrilateral& region, bool whole);
  void expectScales();

  MotionConfig config_;
  MotionAligner aligner_;
  MotionSupport support_;
  MotionAligner::Scales expected_{};
  std::vector<Eigen::Matrix3d> again_;
  MotionEstimate found_;
};

}  // namespace laparoscope_servo::motion
