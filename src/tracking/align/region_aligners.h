// Two aligners of one region: one for the reference's light, and one for light so bright that a colour of the first one
// clips in much of the region, which tracks by the colours that are left.
//
// A mixture shows nothing where one of its colours clips: with gain 1.4 on cholecystectomy_moving_camera.mp4 the
// mixture of all three has 16 % of the region left, that of blue and green 46 %.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "laparoscope_servo/image/colour_patch.h"
#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/tracking/tracker_config.h"
#include "tracking/align/region_aligner.h"

namespace laparoscope_servo::tracking {

class RegionAligners {
 public:
  explicit RegionAligners(const TrackerConfig& config, std::shared_ptr<const image::Lens> lens = nullptr);

  // That of the reference's light.
  RegionAligner& usual() { return usual_; }
  const RegionAligner& usual() const { return usual_; }
  // That of the last image that choose() got; at first the usual one.
  RegionAligner& now() { return bright_now_ ? *bright_ : usual_; }
  const RegionAligner& now() const { return bright_now_ ? *bright_ : usual_; }

  // Call after usual() got its reference from `image`.
  void setBright(const cv::Mat& image);
  // Chooses the aligner for an image in which the region is expected at `start`, and returns where it is to start: the
  // bright one where it has far more of the region left, or more and it was right in the last occlusion/hold images (a
  // lamp that flickers). An aligner that the image before did not have, but one of those, has its own light of then;
  // otherwise it starts afresh.
  EsmState choose(const cv::Mat& image, const EsmState& start);
  // Takes the bright aligner where it has more of a region at `g` left, and returns whether it did: for an image in
  // which the usual one is not right. As long as that one is, it is the more accurate.
  bool turnBright(const cv::Mat& image, const Eigen::Matrix3d& g);
  // Call with what now() found, once that is accepted.
  void remember(const EsmState& accepted);

  // As of RegionAligner, for both.
  void setMask(const cv::Mat& mask);
  void startAfresh();
  void advance();
  void retune(const TrackerConfig& config);

 private:
  using Limits = std::array<int, 3>;  // grey levels from which a blue, green, red pixel shows nothing
  Limits limitsOf(const image::Channels& channels) const;
  struct Light {
    double gain = 1.0, bias = 0.0;  // of EsmState
    int images = 1 << 20;           // since then
  };
  void sample(const cv::Mat& image, const Eigen::Matrix3d& g);
  double left(const Limits& limits) const;
  bool brightHas(double more, const cv::Mat& image, const Eigen::Matrix3d& g);

  TrackerConfig config_;
  std::shared_ptr<const image::Lens> lens_;  // null: none
  RegionAligner usual_;
  std::optional<RegionAligner> bright_;  // empty where no other mixture has more left in bright light
  bool bright_now_ = false;
  std::array<Light, 2> lights_;  // that the usual and the bright aligner had last
  int step_ = 1;                 // px of the reference between two samples
  cv::Size samples_;
  Limits usual_limits_ = {}, bright_limits_ = {};
  image::ColourPatch reference_, patch_;  // samples of the reference and of the current image
};

}  // namespace laparoscope_servo::tracking
