// ESM with the gates of occlusion, from where it is told to start, and no judgement of the outcome: the paper's
// tracker, when the configuration says so.
#pragma once

#include "laparoscope_servo/image/colour_patch.h"
#include "laparoscope_servo/tracking/esm.h"
#include "laparoscope_servo/tracking/occlusion_gates.h"

namespace laparoscope_servo::bench {

class GatedEsm {
 public:
  // CV_8UC3; the ROI lies in the image.
  GatedEsm(const tracking::TrackerConfig& config, const cv::Mat& image, const geometry::Rectangle& roi);

  // Colour gate, ESM, structure gate if the configuration has it, ESM again on what that left.
  tracking::EsmResult align(const cv::Mat& image, const Eigen::Matrix3d& start);

  // An estimate came out, right or wrong.
  static bool usable(const tracking::EsmResult& result);

  // Of the last alignment that was usable.
  double zncc() const { return gates_.correlation(); }
  double visibleFraction() const { return gates_.visibleFraction(); }
  const tracking::OcclusionGates& gates() const { return gates_; }

 private:
  void build(const cv::Mat& image);
  void look(const cv::Mat& image, const Eigen::Matrix3d& g);
  int observeStructure(const tracking::EsmResult& result);

  tracking::TrackerConfig config_;
  tracking::Esm esm_;
  tracking::OcclusionGates gates_;
  image::RegionPyramid pyramid_;
  cv::Size size_;
  Eigen::Matrix3d image_T_patch_ = Eigen::Matrix3d::Identity();
  image::ColourPatch patch_;
};

}  // namespace laparoscope_servo::bench
