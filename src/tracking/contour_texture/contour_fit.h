// One image of the tracker of contour and texture: both in one minimisation (Marchand and Chaumette 2004, II.D), and
// whether what comes out may be believed.
#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "laparoscope_servo/features/feature_state.h"
#include "laparoscope_servo/features/spline.h"
#include "laparoscope_servo/image/pyramid.h"
#include "laparoscope_servo/tracking/contour_texture.h"
#include "tracking/contour_texture/block_gate.h"
#include "tracking/contour_texture/edge_term.h"
#include "tracking/contour_texture/outline.h"
#include "tracking/esm/esm.h"

namespace laparoscope_servo::tracking {

struct ContourEstimate {
  EsmResult esm;
  double share = 0.0;  // of the edges, or of the blocks of texture, that agree: the larger one
  features::Reason reason = features::Reason::kUndetermined;  // kNone: it may be believed
};

class ContourFit {
 public:
  explicit ContourFit(const ContourTextureConfig& config);

  // Takes what is inside of the closed contour, and the edges along it, for the reference. Throws std::invalid_argument
  // when it is too small.
  void setReference(const cv::Mat& image, const features::Spline& contour);

  // From `start`; `prior`: null, nothing is known of the motion. `min_share`: of the edges in the image that have to
  // agree, where the texture alone does not tell.
  ContourEstimate align(const cv::Mat& image, const EsmState& start, const MotionPrior* prior, double min_share);
  // Where the edges alone see the contour at about `g`; empty: nowhere.
  std::optional<Eigen::Matrix3d> elsewhere(const cv::Mat& image, const Eigen::Matrix3d& g);

  // The last estimate is believed: its light and its edges are remembered.
  void remember(const EsmState& state);
  // Nothing is known of the light of the next image, and of what is covered.
  void forget();

  const geometry::Rectangle& roi() const { return roi_; }  // the contour's box
  const Outline& outline() const { return outline_; }
  const Eigen::Matrix3d& normalisation() const { return esm_.normalisation(); }
  // px, of the worst corner of the box, by what the reference alone shows.
  double referenceCornerError() { return esm_.referenceCornerError(noise_); }
  const std::vector<features::SiteFinding>& findings() const { return edges_.findings(); }

 private:
  void build(const cv::Mat& image, const Eigen::Matrix3d& g);
  bool isInView(const cv::Mat& image, const Eigen::Matrix3d& g) const;
  void judge(double min_share, ContourEstimate& estimate);

  ContourTextureConfig config_;
  geometry::Rectangle roi_;
  int finest_ = 1;      // px of the image per px of the finest level
  double noise_ = 1.0;  // grey levels, of the finest level
  Outline outline_;
  Esm esm_;
  image::RegionPyramid pyramid_;
  BlockGate blocks_;
  EdgeTerm edges_;
  bool edges_agree_ = false;  // with the last estimate, by more than chance
  bool edges_count_;          // in the next alignment
};

}  // namespace laparoscope_servo::tracking
