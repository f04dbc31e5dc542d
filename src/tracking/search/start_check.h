// Checks whether a place is worth an alignment: correlates the coarse region of interest (ROI) with the image there and
// nearby. Costs a small part of an unsuccessful alignment. Moves the start to the best place, so that a place found in
// one image can be used in the next ones.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/image/pyramid.h"

namespace laparoscope_servo::tracking {

struct CheckedStart {
  Eigen::Matrix3d g;         // reference to current pixels, determinant 1
  double correlation = 0.0;  // -1 to 1, of local contrast: light and shade do not raise it
};

class StartCheck {
 public:
  // With a lens images are raw; homographies and the ROI are in rectified pixels.
  explicit StartCheck(std::shared_ptr<const image::Lens> lens = nullptr) : lens_(std::move(lens)) {}

  void setReference(const cv::Mat& image, const geometry::Rectangle& roi, const image::ChannelWeights& weights);

  // The place of highest correlation within kReach of `g`; `g` itself with correlation 0 if the ROI is not in the image
  // there.
  CheckedStart look(const cv::Mat& image, const Eigen::Matrix3d& g) const;
  // Pixels of an image of this size that look() takes at `g`.
  double pixelsTaken(const cv::Size& image, const Eigen::Matrix3d& g) const;

  static constexpr double kReach = 0.25;  // share of the ROI's larger side

 private:
  geometry::Rectangle widened(int margin) const;
  cv::Rect boxOf(const cv::Size& image, const Eigen::Matrix3d& g, int margin) const;
  cv::Mat1f contrast(const cv::Mat& image, const Eigen::Matrix3d& g, int margin) const;

  std::shared_ptr<const image::Lens> lens_;
  geometry::Rectangle roi_;
  image::ChannelWeights weights_ = image::kLuma;
  double step_ = 1.0;  // px of the reference per px of the compared patch
  cv::Size size_;      // px, of the compared patch
  int margin_ = 0;     // px of the compared patch, kReach
  cv::Mat1f reference_;
};

}  // namespace laparoscope_servo::tracking
