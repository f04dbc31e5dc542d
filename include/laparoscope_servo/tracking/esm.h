// Efficient second-order minimisation (ESM) on SL(3): aligns a region of the current image with the reference.
//
// Benhimane and Malis' method as used by Bourger et al. (2007), with a gain and a bias of the light, the bias for the whole ROI
// or for each block of it:
//   minimise over G, a, b:  sum w (a I(G p) + b - T(p))^2
// by x = -(J'WJ)^-1 J'W r with J = (a J(grad of the warped image) + J(grad T)) / 2, and G <- G exp(A(x)).
// G acts on normalised template coordinates p = N (u, v, 1): N puts the origin into the ROI's centre and divides by half its
// larger side, so that G is the same at every level of the pyramid and J'J is well conditioned.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/image/patch.h"
#include "laparoscope_servo/image/pyramid.h"
#include "laparoscope_servo/tracking/normal_equations.h"
#include "laparoscope_servo/tracking/tracker_config.h"

namespace laparoscope_servo::tracking {

struct EsmState {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();  // pixels of the reference to pixels of the current image, determinant 1
  double gain = 1.0;                                // gain * image + bias = reference
  double bias = 0.0;                                // grey levels; the mean of the blocks' with Light::kLocal
};

enum class EsmStatus {
  kConverged,
  kMaxIterations,   // still moving by more than min_step; the state is the last iterate
  kIllConditioned,  // the pixels kept do not determine the eight parameters
  kOutOfView,       // the ROI's image crosses infinity, or too little of it is in the image
};

struct EsmResult {
  EsmState state;
  EsmStatus status = EsmStatus::kMaxIterations;
  int iterations = 0;
  double last_step = 0.0;     // px, how far a corner moved in the last iteration
  double sigma = 0.0;         // grey levels, robust standard deviation of the residual at the finest level used
  double corner_error = 0.0;  // px, standard deviation of the worst corner as the residuals predict it; infinite if unknown
};

// One level of the reference, and what an alignment works with there.
struct EsmLevel {
  image::Patch value;
  image::Patch gx;  // per pixel of the level
  image::Patch gy;
  Eigen::Matrix3d image_T_patch;  // pixel (i, j) of the level to pixels of the reference image
  cv::Point first;                // pixel of the ROI that the level's pixel (0, 0) lies on
  double scale = 1.0;             // pixels of the reference image per pixel of the level

  image::Patch weight;    // set by Esm::setWeights
  image::Patch used;      // weight where the image is valid, at the last iteration
  image::Patch warped;    // the image at the last iteration
  image::Patch valid;     // 1 where that lies in the image, with its neighbours; 0 elsewhere
  bool all_valid = true;  // valid is 1 everywhere, and `used` is not written

  int cells_per_strip = 1;  // see sumCells
  int cell_rows = 8;
  // Blocks of light: whole strips of columns, whole cells of rows.
  std::vector<int> block_of_strip;
  std::vector<int> block_row_begin;  // rows; the last is the height
  int block_columns = 0;
  std::vector<double> bias;  // grey levels, per block, row by row; from the last alignment
};

class Esm {
 public:
  // With a lens the pyramids are of raw images, and every other pixel that is spoken of is a rectified one.
  explicit Esm(const EsmConfig& config, std::shared_ptr<const image::Lens> lens = nullptr)
      : config_(config), lens_(std::move(lens)) {}

  // Takes the ROI of the pyramid's image for the reference. The pyramid's region must hold the ROI; levels that would be
  // smaller than 8 px in the ROI's smaller side are not used. The ROI is in whole pixels.
  void setReference(const image::RegionPyramid& reference, const geometry::Rectangle& roi);

  // Weights of the ROI's pixels, CV_32F of its size, for the following alignments. Coarser levels take the least of the
  // weights that a pixel of theirs covers.
  void setWeights(const cv::Mat1f& weights);

  // With Light::kLocal the biases of the blocks go on from one alignment to the next; this starts them afresh from the image.
  void forgetLight();

  // From level `coarsest` (by default the coarsest there is) down to level `finest`.
  EsmResult align(const image::RegionPyramid& current, const EsmState& start, int finest = 0, int coarsest = 1000);

  // px, standard deviation of the worst corner if the reference were seen with independent noise of `sigma` grey levels in
  // reference and image, by the reference's own gradients and the weights; infinite where they do not determine it.
  double referenceCornerError(double sigma);

  int levels() const { return static_cast<int>(levels_.size()); }
  const geometry::Rectangle& roi() const { return roi_; }
  const EsmLevel& level(int l) const { return levels_[l]; }
  // N, see above.
  const Eigen::Matrix3d& normalisation() const { return n_; }

 private:
  void planLight(EsmLevel& level) const;
  void takeReference(const image::RegionPyramid& reference, int l, const cv::Rect& patch, EsmLevel& level) const;
  void warp(const image::RegionPyramid& current, EsmLevel& level, int l, const Eigen::Matrix3d& g);
  void startLight(EsmLevel& level, const EsmState& state);
  double residualScale(const EsmLevel& level, const EsmState& state);
  void accumulate(const EsmLevel& level, const EsmState& state, double sigma);
  bool solve(EsmLevel& level, EsmState& state, double& step);
  double predictedCornerError(double sigma) const;

  EsmConfig config_;
  std::shared_ptr<const image::Lens> lens_;
  geometry::Rectangle roi_;
  Eigen::Matrix3d n_ = Eigen::Matrix3d::Identity();      // N: reference pixels to normalised template coordinates
  Eigen::Matrix3d n_inv_ = Eigen::Matrix3d::Identity();
  double half_size_ = 1.0;                               // px, what N divides by
  std::vector<EsmLevel> levels_;
  NormalEquations equations_;
  std::vector<float> samples_, strip_bias_;
  std::vector<CellSums> cells_;  // of a block row: cell rows times strips
  struct BlockSums {
    double weight;
    double residual;
    Vector10d jacobian;
  };
  std::vector<BlockSums> block_sums_;
  bool light_known_ = false;
};

}  // namespace laparoscope_servo::tracking
