// Aligns a region of interest (ROI) of the reference with one image: occlusion gates choose the pixels, ESM aligns
// them, the gates are evaluated again on the result, until no further area is rejected; then block matching checks and
// corrects the estimate.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>

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
  EsmResult esm;                  // iterations: of all alignments together
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

struct ReferenceTexture {
  double noise = 0.0;         // grey levels, of the finest level: the image's own, or kTypicalNoise where that is more
  double corner_error = 0.0;  // px, that this noise causes; infinite where the texture does not determine the motion
};
constexpr double kTypicalNoise = 2.0;  // grey levels, of a laparoscope's camera, as the finest level shows it

class RegionAligner {
 public:
  // With a lens images are raw; the ROI and homographies are in rectified pixels.
  explicit RegionAligner(const TrackerConfig& config, std::shared_ptr<const image::Lens> lens = nullptr);

  // `roi`: whole pixels, shown by the image (CV_8UC1 or CV_8UC3). Everything is visible in the reference but its
  // highlights.
  void setReference(const cv::Mat& image, const geometry::Rectangle& roi);

  // Starts at `start`. `reach` [px]: by how much a corner may have moved from there without the image's crop being
  // left.
  Alignment align(const cv::Mat& image, const EsmState& start, const MotionPrior* prior, double reach);

  // See RegionTracker::retune.
  void retune(const TrackerConfig& config) { gates_.setThreshold(config.occlusion.threshold); }

  // Forgets occlusions and light of the last alignment, before one that starts elsewhere.
  void startAfresh();
  // An image is done: see OcclusionGates::advance.
  void advance() { gates_.advance(); }

  // Of the last alignment: correlation of fine structure, see detailCorrelation.
  double detail() const;

  // Of an image of `size`: 255 where a pixel of the ROI, seen there at `g`, is taken for occluded, 0 elsewhere.
  cv::Mat occlusionMask(const Eigen::Matrix3d& g, const cv::Size& size) const;

  // What the reference's texture, beyond its noise, determines.
  ReferenceTexture referenceTexture();

  const Esm& esm() const { return esm_; }
  const OcclusionGates& gates() const { return gates_; }
  // Of the ROI's pixels, as they are used now; valid until the next call of anything here.
  cv::Mat1f weights() { return gates_.weights().view(); }
  const image::Channels& channels() const { return channels_; }
  const geometry::Rectangle& roi() const { return esm_.roi(); }

 private:
  void sample(const cv::Mat& image, const Eigen::Matrix3d& g);
  void look(const cv::Mat& image, const Eigen::Matrix3d& g);
  void follow(const ShiftFit& fit, EsmResult& estimate) const;
  const std::vector<BlockShift>& measure(const EsmResult& estimate, BlockEvidence& evidence);
  int visibleBlocks(const std::vector<BlockShift>& shifts) const;
  void correct(EsmResult& estimate, BlockEvidence& evidence);
  void lookFurther(EsmResult& estimate, BlockEvidence& evidence);
  int observeStructure(const EsmResult& estimate);

  EsmConfig config_;
  std::shared_ptr<const image::Lens> lens_;
  OcclusionConfig occlusion_;
  Esm esm_;
  OcclusionGates gates_;
  BlockMatching blocks_;
  BlockMatching far_blocks_;
  image::RegionPyramid pyramid_;
  image::Channels channels_ = image::kLuma;
  image::ColourPatch patch_;
  Eigen::Matrix3d shown_ = Eigen::Matrix3d::Identity();  // the homography at which the colour gate was last evaluated
  double noise_ = 0.0;                                   // grey levels, of the reference image
  double surprise_ = 0.0;  // px, by how much a corner was off the prediction in the last image
};

// Pixels of a patch of the ROI's size to those of the image that the ROI is taken from.
Eigen::Matrix3d imageFromPatch(const geometry::Rectangle& roi);

}  // namespace laparoscope_servo::tracking
