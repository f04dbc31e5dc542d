// Aligns a region of interest (ROI) of the reference with one image. The order in align():
//   1. Colour gate at the start, unless the last prediction was too far off for its mask to fit.
//   2. ESM on the coarse levels.
//   3. ESM on the finest level. If the estimate has left the place at which the colour gate was evaluated, the gate is
//      evaluated again there, before and at most once more after this step.
//   4. Structure gate on the aligned region; while it rejects further areas, ESM on the finest level again.
//   5. Block matching checks the estimate, and corrects it where both contradict each other.
//   6. If most blocks were not found, block matching on a coarser level, which searches further.
//
// All of it works on patches of at most kMostPixels: for a larger ROI the finest level is coarser than the image. The
// errors that are claimed are those of what was used.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/colour_patch.h"
#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/image/pyramid.h"
#include "laparoscope_servo/tracking/tracker_config.h"
#include "tracking/align/block_matching.h"
#include "tracking/align/quality.h"
#include "tracking/align/shift_fit.h"
#include "tracking/esm/esm.h"
#include "tracking/occlusion/occlusion_gates.h"

namespace laparoscope_servo::tracking {

struct Alignment {
  EsmResult esm;                  // its `iterations` and its `work` are those of all alignments together
  bool in_image = true;           // false: the ROI is expected outside the image, nothing was aligned
  double visible_fraction = 0.0;  // 0 to 1, share of the ROI's pixels that were used
  double share_in_image = 1.0;    // 0 to 1, of the ROI's pixels
  double zncc = 0.0;              // see OcclusionGates::correlation
  BlockEvidence blocks;
  // px, standard deviations that are claimed: with what the tissue deforms by, which residuals do not show, as ESM has
  // followed it.
  double corner_error = 0.0;
  double centre_error = 0.0;
};

struct AlignmentLimits {
  double most_work = std::numeric_limits<double>::infinity();  // EsmResult::work
  int coarsest = 1000;  // level to begin with; 1000: the coarsest, another one to go on after an interruption
};

struct ReferenceTexture {
  double noise = 0.0;         // grey levels, of the finest level: the image's own, or kTypicalNoise where that is more
  double corner_error = 0.0;  // px, that this noise causes; infinite where the texture does not determine the motion
};
// grey levels, of a laparoscope's camera, in a level of scale 1
constexpr double kTypicalNoise = 2.0;

class RegionAligner {
 public:
  // With a lens images are raw; the ROI and homographies are in rectified pixels.
  explicit RegionAligner(const TrackerConfig& config, std::shared_ptr<const image::Lens> lens = nullptr);

  // `roi`: whole pixels, shown by the image (CV_8UC1 or CV_8UC3). In the reference everything counts as visible except
  // highlights. `channels`: that are tracked; empty: those that chosenChannels() finds.
  void setReference(const cv::Mat& image, const geometry::Rectangle& roi,
                    const std::optional<image::Channels>& channels = std::nullopt);

  // Aligns from `start`. `reach` [px]: how far a corner may be from there without leaving the crop of the image that is
  // used. `limits`: where it begins, and from where on it is interrupted.
  Alignment align(const cv::Mat& image, const EsmState& start, const MotionPrior* prior, double reach,
                  const AlignmentLimits& limits = AlignmentLimits());

  // See RegionTracker::retune.
  void retune(const TrackerConfig& config) { gates_.setThreshold(config.occlusion.threshold); }

  // Of the image that setReference() or align() gets next, and its size: what is not 0 is covered. Empty: nothing is
  // known. Stays until it is set again.
  void setMask(const cv::Mat& mask) { mask_ = mask; }
  const cv::Mat& mask() const { return mask_; }

  // Forgets occlusions and light of the last alignment, before one that starts elsewhere.
  void startAfresh();
  // Call at the end of an image, see OcclusionGates::advance.
  void advance() { gates_.advance(); }

  // Correlation of the fine structure at the last alignment, see detailCorrelation.
  double detail() const;

  // Mask of an image of `size`: 255 where the ROI, seen at `g`, counts as occluded, 0 elsewhere.
  cv::Mat occlusionMask(const Eigen::Matrix3d& g, const cv::Size& size) const;

  // What the reference's texture, beyond its noise, determines.
  ReferenceTexture referenceTexture();

  const BlockMatching& blocks() const { return blocks_; }
  const Esm& esm() const { return esm_; }
  const OcclusionGates& gates() const { return gates_; }
  // Current weights of the finest level's pixels; valid until the next call of a member function.
  cv::Mat1f weights() { return gates_.weights().view(); }
  const image::Channels& channels() const { return channels_; }
  const geometry::Rectangle& roi() const { return esm_.roi(); }

 private:
  cv::Size patchSize() const;
  void sample(const cv::Mat& image, const Eigen::Matrix3d& g);
  void sample(const cv::Mat& image, const Eigen::Matrix3d& g, image::ColourPatch& patch) const;
  void look(const cv::Mat& image, const Eigen::Matrix3d& g);
  void follow(const ShiftFit& fit, EsmResult& estimate) const;
  const std::vector<BlockShift>& measure(const EsmResult& estimate, BlockEvidence& evidence);
  // The pixels of a block, with its centre and side in px of the reference, have weight.
  bool isVisible(const Eigen::Vector2d& centre, double side) const;
  void correct(EsmResult& estimate, BlockEvidence& evidence);
  void correctFinely(EsmResult& estimate, BlockEvidence& evidence);
  void lookFurther(EsmResult& estimate, BlockEvidence& evidence);
  int observeStructure(const EsmResult& estimate);

  EsmConfig config_;
  std::shared_ptr<const image::Lens> lens_;
  OcclusionConfig occlusion_;
  Esm esm_;
  OcclusionGates gates_;
  BlockMatching blocks_;
  BlockMatching far_blocks_;
  BlockMatching fine_blocks_{lens_};  // of the next finer level, where there is one
  int finest_ = 1;                    // scale of the finest level
  image::RegionPyramid pyramid_;
  image::Channels channels_ = image::kLuma;
  image::ColourPatch patch_;
  cv::Mat mask_;
  image::ColourPatch covered_;                           // the mask, as the patch is sampled
  Eigen::Matrix3d shown_ = Eigen::Matrix3d::Identity();  // the homography at which the colour gate was last evaluated
  DeformationMemory deformation_;
  double noise_ = 0.0;     // grey levels, noise of the reference image
  double surprise_ = 0.0;  // px, distance of the worst corner from the prediction in the last image
};

// px of the image per px of the finest level on which a ROI of this size is tracked, a power of 2: the least for which
// the ROI has no more than kMostPixels there.
constexpr double kMostPixels = 200000.0;
int finestScale(const geometry::Rectangle& roi);

}  // namespace laparoscope_servo::tracking
