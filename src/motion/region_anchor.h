// Where a region is by comparison with the image in which it was selected. What is added up from image to image drifts,
// and leads on to what lies in the region's place while something else hides it.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "motion/motion_estimator.h"

namespace laparoscope_servo::motion {

class RegionAnchor {
 public:
  explicit RegionAnchor(const MotionConfig& config);

  // `image`: of which only `box` is kept, the part about the region; `mask`: of the image, may be empty. All px of the
  // whole image.
  void begin(const cv::Mat& image, const cv::Mat& mask, const cv::Rect& box, const geometry::Quadrilateral& region);
  // Adds the motion from the image before. `error`: px, expected at the worst corner; infinite: the motion was not
  // seen, and `step` is what is expected.
  void goOn(const Eigen::Matrix3d& step, double error);
  // Compares `box` of this image with the anchor, from where the region is expected. False: nothing is believed of it,
  // and the region is where the steps have led it.
  bool compare(const MotionImage& current, const cv::Rect& box);

  const Eigen::Matrix3d& motion() const { return g_; }  // from the anchor's image to this one, determinant 1
  geometry::Quadrilateral region() const { return geometry::apply(g_, region_); }
  // Each step since the last comparison was seen.
  bool isKnown() const { return known_; }
  // Of the last comparison, and the middle of what it is about, px of the whole image.
  const MotionEstimate& found() const { return found_; }
  Eigen::Vector2d middle() const;

 private:
  bool isPlausible(const Eigen::Matrix3d& g) const;

  MotionConfig config_;
  MotionEstimator estimator_;
  MotionImage anchor_;
  cv::Rect box_;
  geometry::Quadrilateral region_{};
  Eigen::Matrix3d g_ = Eigen::Matrix3d::Identity(), compared_ = Eigen::Matrix3d::Identity();  // now; when last compared
  bool known_ = false;
  double variance_ = 0.0;  // px^2, of the steps since the last comparison
  std::vector<Eigen::Matrix3d> starts_;
  MotionEstimate found_;
};

}  // namespace laparoscope_servo::motion
