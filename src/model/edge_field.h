// How far each pixel of a reduced image is from the nearest edge of about a given direction.
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>

namespace laparoscope_servo::model {

class EdgeField {
 public:
  static constexpr int kBins = 6;            // of directions, 30 degrees each
  static constexpr float kFarthest = 24.0f;  // px of the reduced image: what is further is as far as this

  // `area` of the image, CV_8UC1 or CV_8UC3, reduced to 1 / 2^level; what of it lies outside of the image has no edges.
  // Edges weaker than `min_contrast` grey levels are none.
  void compute(const cv::Mat& image, const cv::Rect& area, int level, double min_contrast);

  static int bin(const Eigen::Vector2d& normal);
  // Pixels of the image to those of the field.
  Eigen::Vector2d toField(const Eigen::Vector2d& pixel) const;
  double scale() const { return scale_; }
  cv::Size size() const { return distance_[0].size(); }
  // Row by row, px of the field.
  const cv::Mat1f& distances(int bin) const { return distance_[static_cast<std::size_t>(bin)]; }
  // At a place in the field, with its derivative along the normal; kFarthest and 0 outside.
  double distance(const Eigen::Vector2d& place, const Eigen::Vector2d& normal, double& slope) const;

 private:
  std::array<cv::Mat1f, kBins> distance_;
  cv::Point origin_;
  double scale_ = 1.0;
};

}  // namespace laparoscope_servo::model
