// ViSP's moving edges and dots, with the sites and the range of ours.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/features/ellipse.h"

namespace laparoscope_servo::bench {

class VispLine {
 public:
  VispLine();
  ~VispLine();
  void select(const cv::Mat& image, const Eigen::Vector2d& begin, const Eigen::Vector2d& end);
  // False when it says that it lost it.
  bool track(const cv::Mat& image);
  // x cos(theta) + y sin(theta) = rho, px
  double rho() const;
  double theta() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

class VispEllipse {
 public:
  VispEllipse();
  ~VispEllipse();
  void select(const cv::Mat& image, const std::vector<Eigen::Vector2d>& points);
  bool track(const cv::Mat& image);
  features::Ellipse ellipse() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

class VispDot {
 public:
  VispDot();
  ~VispDot();
  void select(const cv::Mat& image, const Eigen::Vector2d& point);
  bool track(const cv::Mat& image);
  Eigen::Vector2d centre() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace laparoscope_servo::bench
