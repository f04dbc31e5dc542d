// Estimates the dominant motion from one image to another: eq. (9) of Marchand and Chaumette (2004),
//   minimise over the motion, gain a and offset b:  sum rho(a I(G x, t + 1) + b - I(x, t))
// with Tukey's rho, from coarse to fine, by the residuals, weights, sums and steps of ESM (tracking/esm/esm.h): the
// directions of sl(3) are the velocities of eq. (8), so a model with fewer parameters is a part of ESM's equations. On
// the finest level each block of the image has an offset b of its own: the lamp of a scope goes along with it, so that
// its shading stays in the image while the tissue moves, and one gain for all pixels would bias the motion.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "laparoscope_servo/geometry/sl3.h"
#include "laparoscope_servo/motion/motion_config.h"
#include "motion/cell_votes.h"
#include "motion/motion_image.h"
#include "motion/shading.h"
#include "motion/shift_votes.h"
#include "motion/usable_pixels.h"
#include "tracking/esm/esm_level.h"
#include "tracking/esm/normal_equations.h"
#include "tracking/esm/residual.h"

namespace laparoscope_servo::motion {

struct Alignment {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();  // pixels of the reference to those of the image, determinant 1
  double gain = 1.0;                                // gain * image + offset = reference
  double offset = 0.0;                              // grey levels
  double sigma = 0.0;                               // grey levels, robust standard deviation of the finest residuals
  int iterations = 0;
  bool determined = false;  // false: what can be used of the images does not determine the motion
  double last_step = std::numeric_limits<double>::infinity();  // px, of a corner
};

class MotionAligner {
 public:
  static constexpr int kMostStarts = 4;
  using Scales = std::array<double, MotionImage::kMostLevels>;

  // `shaded`: the images may lie so far apart that the light differs from place to place, see Shading.
  explicit MotionAligner(const MotionConfig& config, bool shaded = false)
      : config_(config), shaded_(shaded && config.light) {}

  // Allocates for the first image, and for one of another size.
  void setReference(const MotionImage& image);

  // Sets which pixels the following alignments use: those usable in the reference and, where `g` takes them, in
  // `current`.
  JointUse setUsable(const MotionImage& reference, const MotionImage& current, const Eigen::Matrix3d& g,
                     const geometry::Quadrilateral* region);

  // `starts`: motions to start from, the expected one first; the one by the blocks' votes is added. `expected`: the
  // scale of the residuals at each level in earlier images; 0: not known. It bounds the scale, so that what moves
  // otherwise is not taken for noise.
  Alignment align(const MotionImage& current, const std::vector<Eigen::Matrix3d>& starts, const Scales& expected);

  // Of the last alignment.
  const Scales& scales() const { return scales_; }  // found at each level
  // The covariance of a0 to a7 about the image's centre (rows that the model does not have are 0), by the residuals of
  // blocks of pixels, which err together, and by what sampling does to a shift. Empty when the equations do not
  // determine them.
  std::optional<tracking::Matrix8d> covariance() const;
  const tracking::LevelEquations& equations() const { return equations_; }
  // Warps level `l` of the image into level(l), as the last alignment left it: with one offset, or with the blocks'
  // own.
  void warp(const MotionImage& current, int l, const Alignment& at);
  // Sums the equations of that level, with Tukey's weights at the scale found there, or without weights by residuals.
  void sum(int l, const Alignment& at, bool robust);

  int levels() const { return static_cast<int>(levels_.size()); }
  const tracking::EsmLevel& level(int l) const { return levels_[static_cast<std::size_t>(l)]; }
  const geometry::Rectangle& frame() const { return frame_; }  // the whole image

 private:
  double scaleOf(int l, const tracking::ResidualScale& scale, double found) const;
  struct Unknowns {
    int motion;  // the first so many of sl(3)
    bool gain, offset;
  };
  Unknowns all() const { return {parametersOf(config_.model), config_.light, config_.light}; }
  // On coarser levels, where the motion may be far off yet, the offsets would take up what drives it.
  bool hasOwnOffsets(int l) const { return l == 0 && config_.light; }
  enum class Offsets { kOne, kBegin, kGoOn };  // one for all pixels; of each block, begun anew or as they are
  bool step(const MotionImage& current, int l, const Unknowns& unknowns, Offsets offsets,
            tracking::ResidualScale& scale, Alignment& at, bool warped = false);
  void warpImage(const MotionImage& current, int l, const Eigen::Matrix3d& g);
  void fitShading(const MotionImage& current, int l, const Eigen::Matrix3d& g);
  void setOffset(int l, double offset);
  void beginOffsets(int l, const Alignment& at);
  void stepOffsets(int l, const tracking::Vector10d& x, Alignment& at);
  double costOf(std::size_t start, double sigma, int most) const;
  bool judgeAgain(const MotionImage& current, int l, const Eigen::Matrix3d& predicted, Alignment& at);
  Alignment bestStart(const MotionImage& current, const std::vector<Eigen::Matrix3d>& starts);
  void refine(const MotionImage& current, int l, bool warped, Alignment& at);

  MotionConfig config_;
  bool shaded_;
  Shading shading_;
  geometry::Rectangle frame_;
  geometry::Sl3Steps steps_;
  std::vector<tracking::EsmLevel> levels_;
  Squares joint_;
  bool all_usable_ = false;  // the levels' weights are all 1
  ShiftVotes votes_;
  CellVotes cell_votes_;
  std::array<tracking::ResidualScale, kMostStarts> residuals_;  // of the starts
  tracking::LevelEquations equations_;
  std::vector<float> differences_;  // of a block
  Scales expected_{};
  Scales scales_{};
};

}  // namespace laparoscope_servo::motion
