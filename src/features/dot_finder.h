// Finds one dot near a place, and measures it.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/features/dots.h"

namespace laparoscope_servo::features {

// What is remembered of a dot.
struct DotLooks {
  double level = 0.0;       // grey levels, inside
  double background = 0.0;  // around it
  double area = 0.0;        // px^2
  double flatness = 1.0;    // smaller over larger radius
};

struct DotMeasurement {
  bool found = false;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  // px
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  DotLooks looks;
  double roughness = 0.0;  // px, the largest difference of the outline from an ellipse
};

class DotFinder {
 public:
  explicit DotFinder(const DotsConfig& config);

  // The dot next to `expected` that looks like `looks`, no further away than the range.
  DotMeasurement find(const cv::Mat& image, const Eigen::Vector2d& expected, const DotLooks& looks);
  // The dot at `point` of which nothing is known, brighter or darker than what is around it.
  DotMeasurement discover(const cv::Mat& image, const Eigen::Vector2d& point);

 private:
  // Pixels that hang together, on one side of a threshold.
  struct Blob {
    int count = 0;
    cv::Rect box;
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();  // px^2, second moments about the centre
    bool whole = false;                                // it does not go on outside of the window
  };

  void open(const cv::Mat& image, const Eigen::Vector2d& about, double half);
  float at(int u, int v) const { return pixels_[static_cast<std::size_t>(v * window_.width + u)]; }
  bool isInside(int u, int v, double threshold, bool bright) const {
    return bright ? at(u, v) > threshold : at(u, v) < threshold;
  }
  // From the window's pixel (u, v), which is inside and not taken yet.
  Blob grow(int u, int v, double threshold, bool bright, int most);
  bool matches(const Blob& blob, const DotLooks& looks) const;
  // With the levels of the dot itself; false when it is no dot.
  bool measure(const Blob& blob, double level, double background, DotMeasurement& result);
  DotMeasurement search(const Eigen::Vector2d& expected, const DotLooks& looks, double threshold);

  DotsConfig config_;
  cv::Rect window_;
  std::vector<float> pixels_;   // of the window, luma
  std::vector<float> outside_;  // px, of a part of them: how far beyond an outline
  std::vector<unsigned char> taken_;
  std::vector<cv::Point> stack_;
};

}  // namespace laparoscope_servo::features
