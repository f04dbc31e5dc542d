// A patch of one channel with a margin around it, so that kernels can read neighbours and whole strips of columns
// without checks at the border.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace laparoscope_servo::image {

class Patch {
 public:
  // Kernels work on strips of this many columns.
  static constexpr int kStrip = 16;

  // Margin and contents are 0 after a change of size. A call with the same size does nothing.
  void resize(int width, int height) {
    if (width == width_ && height == height_) return;
    width_ = width;
    height_ = height;
    stride_ = (width + kStrip - 1) / kStrip * kStrip + 2 * kStrip;
    data_.assign(static_cast<std::size_t>(stride_) * (height + 2), 0.0f);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  int strips() const { return stride_ / kStrip - 2; }
  int stride() const { return stride_; }
  // Row -1 and row height() exist, and columns -kStrip .. strips() * kStrip + kStrip - 1 of every row.
  float* row(int j) { return data_.data() + static_cast<std::size_t>(j + 1) * stride_ + kStrip; }
  const float* row(int j) const { return data_.data() + static_cast<std::size_t>(j + 1) * stride_ + kStrip; }
  float& operator()(int j, int i) { return row(j)[i]; }
  float operator()(int j, int i) const { return row(j)[i]; }

  // The patch without its margin, on the same memory.
  cv::Mat1f view() { return cv::Mat1f(height_, width_, row(0), stride_ * sizeof(float)); }
  const cv::Mat1f view() const {
    return cv::Mat1f(height_, width_, const_cast<float*>(row(0)), stride_ * sizeof(float));
  }

  // Continues the patch linearly by one pixel on each side, so that a central difference at its border is the one-sided
  // one.
  void extrapolate();

 private:
  int width_ = 0;
  int height_ = 0;
  int stride_ = 0;
  std::vector<float> data_;
};

}  // namespace laparoscope_servo::image
