// Windows around points: samples of a level of the pyramid on a grid of its own.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "features/points/point_image.h"

namespace laparoscope_servo::features {

// A square of (2 half + 1)^2 pixels with a margin of one pixel, from which gradients come. Rows are padded to whole
// vectors; what is padded is not valid.
class Window {
 public:
  explicit Window(int half = 0);

  int half() const { return half_; }
  int side() const { return 2 * half_ + 1; }
  // Of pixels, without the margin, with the padding: the length of the arrays below.
  int count() const { return side() * stride_; }
  int stride() const { return stride_; }

  // Samples level `l` of the image, bilinear, at centre + a p, p from (-half - 1, -half - 1) to (half + 1, half + 1);
  // `centre` and `a` in pixels of the image. Returns the share of pixels that are valid: in the image, and usable.
  double sample(const PointImage& image, int l, const Eigen::Vector2d& centre, const Eigen::Matrix2d& a);

  // Row by row, `stride` apart. Gradients: central differences, per pixel of the window.
  const float* values() const { return values_.data(); }
  const float* gradientX() const { return gx_.data(); }
  const float* gradientY() const { return gy_.data(); }
  const float* valid() const { return valid_.data(); }
  // Mean and standard deviation of the valid pixels.
  double mean() const { return mean_; }
  double contrast() const { return contrast_; }

  // Bilinear, at p of the window from its centre. False where p or what it needs lies outside or is not valid.
  bool at(double x, double y, float& value) const;

 private:
  void fill(const cv::Mat1f& level, const Eigen::Vector2d& centre, const Eigen::Matrix2d& a);
  void differentiate();
  double summarise();

  int half_ = 0, stride_ = 0;
  std::vector<float> margin_;  // (2 half + 3)^2, the samples
  std::vector<float> values_, gx_, gy_, valid_;
  double mean_ = 0.0, contrast_ = 0.0;
};

}  // namespace laparoscope_servo::features
