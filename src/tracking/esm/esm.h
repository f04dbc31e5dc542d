// Efficient second-order minimisation (ESM) on SL(3): aligns a region of the current image with the reference.
//
// Benhimane and Malis' method as used by Bourger et al. (2007), with a gain and a bias of the light, the bias for the
// whole ROI or for each block of it:
//   minimise over G, a, b:  sum w (a I(G p) + b - T(p))^2, over the pixels of one channel or of three,
// by x = -(J'WJ)^-1 J'W r with J = (a J(grad of the warped image) + J(grad T)) / 2, and G <- G exp(A(x)).
// G acts on normalised template coordinates p = N (u, v, 1): N puts the origin into the ROI's centre and divides by
// half its larger side, so that G is the same at every level of the pyramid and J'J is well conditioned.
//
// Where the steps of Gauss-Newton are:
//   warp, valid pixels                       Esm::warp, esm_level
//   residual scale, weights                  residual (scale), esm_kernels (Tukey's weights)
//   gradients, sums over cells of pixels     esm_kernels
//   J'WJ, J'Wr; elimination of block biases  normal_equations
//   x, prior                                 Esm::solve
//   G <- G exp(A(x)), gain, biases           Esm::takeStep
//   covariance, corner error                 Esm::judge, covariance
// reference_esm has all of it in one short function, without illumination and weights.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/geometry/sl3.h"
#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/image/pyramid.h"
#include "laparoscope_servo/tracking/tracker_config.h"
#include "tracking/esm/esm_level.h"
#include "tracking/esm/extra_term.h"
#include "tracking/esm/normal_equations.h"
#include "tracking/esm/residual.h"

namespace laparoscope_servo::tracking {

struct EsmState {
  Eigen::Matrix3d g =
      Eigen::Matrix3d::Identity();  // pixels of the reference to pixels of the current image, determinant 1
  double gain = 1.0;                // gain * image + bias = reference
  double bias = 0.0;                // grey levels; with Light::kLocal the mean of the blocks' biases
};

enum class EsmStatus {
  kConverged,
  kMaxIterations,   // still moving by more than min_step; the state is the last iterate
  kIllConditioned,  // the pixels kept do not determine the eight parameters
  kOutOfView,       // the ROI's image crosses infinity, or too little of it is in the image
  kInterrupted,     // what Esm::allow() allowed is used up; the state is the last iterate
};

struct EsmResult {
  EsmState state;
  EsmStatus status = EsmStatus::kMaxIterations;
  int iterations = 0;
  double work = 0.0;                  // the iterations, each by its level's share of the pixels of level 0
  int level = 0;                      // of the last iteration
  double last_step = 0.0;             // px, how far a corner moved in the last iteration
  double last_step_deviations = 0.0;  // last_step in standard deviations of the estimate, root mean square
  double sigma = 0.0;                 // grey levels, robust standard deviation of the residual at the finest level used
  // Covariance of the estimate's error x (see MotionPrior), from residuals and prior. Undefined if corner_error is
  // infinite.
  Matrix8d covariance = Matrix8d::Zero();
  // Grey levels squared. Residuals of real tissue are correlated. This is the variance of independent residuals for
  // which J'WJ would give an estimate of the same uncertainty.
  double noise = 0.0;
  double corner_error =
      0.0;  // px in the image, standard deviation of the worst corner, prior included; infinite if unknown
  double centre_error = 0.0;  // px in the image, standard deviation of the ROI's centre
};

// What is known of the motion before the image is seen: the deviation x of G from `predicted`, G = predicted N^-1
// exp(A(x)) N, has the inverse covariance `information` [normalised template units]. The prior is down-weighted when
// the estimate deviates far from it.
struct MotionPrior {
  Eigen::Matrix3d predicted = Eigen::Matrix3d::Identity();
  Matrix8d information = Matrix8d::Zero();
  // grey levels squared, EsmResult::noise of earlier images: scales `information` to the units of J'WJ
  double noise = 100.0;
};

class Esm {
 public:
  // With a lens the pyramids are of raw images; all other pixel coordinates are rectified.
  explicit Esm(const EsmConfig& config, std::shared_ptr<const image::Lens> lens = nullptr)
      : config_(config), lens_(std::move(lens)) {}

  // Takes the ROI of the pyramid's image for the reference, in as many channels as the pyramid has. The pyramid's
  // region must hold the ROI; levels that would be smaller than 8 px in the ROI's smaller side are not used. The ROI is
  // in whole pixels.
  void setReference(const image::RegionPyramid& reference, const geometry::Rectangle& roi);

  // Sets the weights of level 0's pixels, CV_32F of its size, for the following alignments. A pixel of a coarser level
  // gets the least of the weights that it covers.
  void setWeights(const cv::Mat1f& weights);

  // With Light::kLocal each alignment starts with the blocks' biases of the last one. After this call they are
  // estimated anew.
  void forgetLight();

  // Allows this much EsmResult::work for all alignments until the next call. At first nothing limits it.
  void allow(double work) { allowed_ = work; }

  // Aligns from level `coarsest` (by default the coarsest there is) down to level `finest`. The members of the result
  // on uncertainty are valid only if `finest` is 0. `extra`: minimised together with the residuals, null: nothing.
  EsmResult align(const image::RegionPyramid& current, const EsmState& start, const MotionPrior* prior = nullptr,
                  int coarsest = 1000, int finest = 0, ExtraTerm* extra = nullptr);

  // px, standard deviation of the worst corner if the reference were seen with independent noise of `sigma` grey levels
  // in reference and image, by the reference's own gradients and the weights; infinite where they do not determine it.
  double referenceCornerError(double sigma);

  int levels() const { return static_cast<int>(levels_.size()); }
  const geometry::Rectangle& roi() const { return roi_; }
  const EsmLevel& level(int l) const { return levels_[l]; }
  // N of the head comment.
  const Eigen::Matrix3d& normalisation() const { return steps_.normalisation(); }
  const geometry::Sl3Steps& steps() const { return steps_; }

 private:
  void warp(const image::RegionPyramid& current, EsmLevel& level, int l, const Eigen::Matrix3d& g);
  void startLight(EsmLevel& level, const EsmState& state);
  double rejection(double sigma) const;
  Vector10d accelerated(const Matrix10d& a, const Vector10d& x);
  bool solve(EsmLevel& level, const MotionPrior* prior, bool shift_only, EsmResult& result);
  void takeStep(EsmLevel& level, const Vector10d& x, EsmState& state);
  struct Iteration {
    Light light;      // that the equations have
    bool shift_only;  // false: all eight parameters
    bool match_mean;  // sets the mean residual to zero first
  };
  // One Gauss-Newton step. Returns kMaxIterations for "continue", otherwise the failure.
  EsmStatus iterate(const image::RegionPyramid& current, int l, const MotionPrior* prior, const Iteration& how,
                    EsmResult& result);
  // Far from alignment, on the coarsest level: gain and bias stay fixed, and the first steps are shifts.
  EsmStatus approach(const image::RegionPyramid& current, int l, const MotionPrior* prior, EsmResult& result);
  // Close to alignment: iterates until converged, with all unknowns.
  EsmStatus settle(const image::RegionPyramid& current, int l, int patience, const MotionPrior* prior,
                   EsmResult& result);
  // One level: settle(), preceded by approach() if the first steps show that the region is far away.
  EsmStatus alignLevel(const image::RegionPyramid& current, int l, bool first, const MotionPrior* prior,
                       EsmResult& result);
  // Fills in covariance, noise and expected errors of the final estimate.
  void judge(const MotionPrior* prior, EsmResult& result);
  // What `extra_` says at the state; the score is 0 and so is the information where there is none.
  void askExtra(const EsmState& state);

  EsmConfig config_;
  std::shared_ptr<const image::Lens> lens_;
  geometry::Rectangle roi_;
  geometry::Sl3Steps steps_;  // N: reference pixels to normalised template coordinates
  std::vector<EsmLevel> levels_;
  LevelEquations equations_;
  ResidualScale residual_scale_;
  std::vector<float> scratch_;
  // the last step on this level, see accelerated(); empty after a step that was lengthened
  std::optional<Vector10d> last_step_;
  ExtraTerm* extra_ = nullptr;  // of the present alignment
  Matrix10d extra_information_ = Matrix10d::Zero();
  Vector10d extra_score_ = Vector10d::Zero();
  double allowed_ = std::numeric_limits<double>::infinity();  // work that is left
  bool light_known_ = false;
  std::uint64_t alignments_ = 0;  // number of alignments of a level so far
  // unknowns of the illumination in the equations of this iteration
  Light light_ = Light::kConstant;
  geometry::Vector8d deviation_ = geometry::Vector8d::Zero();  // x of the current iterate from the prior's prediction
};

}  // namespace laparoscope_servo::tracking
