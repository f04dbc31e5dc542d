// What a camera with a lens sees of the synthetic images.
#pragma once

#include <Eigen/LU>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "laparoscope_servo/image/lens.h"

namespace laparoscope_servo::test {

class LensView {
 public:
  LensView(const image::Lens& lens, const cv::Size& raw_size) : rectified_(raw_size) {
    for (int v = 0; v < raw_size.height; ++v) {
      for (int u = 0; u < raw_size.width; ++u) {
        const auto p = lens.toRectified(Eigen::Vector2d(u, v));
        rectified_(v, u) = p ? cv::Vec2d(p->x(), p->y()) : cv::Vec2d(-1e6, -1e6);
      }
    }
  }

  // The raw image of a scene whose pixel p is at g p in rectified pixels; black where the scene ends. Sampled from the
  // scene at once, so that nothing but the lens comes between.
  cv::Mat operator()(const cv::Mat& scene, const Eigen::Matrix3d& g) const {
    const Eigen::Matrix3d inverse = g.inverse();
    cv::Mat2f map(rectified_.size());
    for (int v = 0; v < map.rows; ++v) {
      for (int u = 0; u < map.cols; ++u) {
        const Eigen::Vector3d q = inverse * Eigen::Vector3d(rectified_(v, u)[0], rectified_(v, u)[1], 1.0);
        map(v, u) = cv::Vec2f(static_cast<float>(q.x() / q.z()), static_cast<float>(q.y() / q.z()));
      }
    }
    cv::Mat image;
    cv::remap(scene, image, map, cv::noArray(), cv::INTER_CUBIC, cv::BORDER_CONSTANT);
    return image;
  }

 private:
  cv::Mat2d rectified_;
};

// A wide laparoscope, with the barrel distortion that they have.
inline image::LensParameters laparoscope(const cv::Size& size, double focal_length) {
  image::LensParameters p;
  p.coefficients = {-0.38, 0.16, 0.0008, -0.0006, -0.02};
  p.raw = {focal_length, 1.01 * focal_length, 0.5 * size.width + 3.3, 0.5 * size.height - 2.6};
  p.rectified = {0.95 * focal_length, 0.95 * focal_length, 0.5 * size.width, 0.5 * size.height};
  return p;
}

inline image::LensParameters rational(const cv::Size& size, double focal_length) {
  image::LensParameters p = laparoscope(size, focal_length);
  p.distortion = image::Distortion::kRationalPolynomial;
  p.coefficients = {0.35, -0.05, 0.0005, -0.0004, 0.004, 0.72, 0.06, 0.002};
  return p;
}

inline image::LensParameters equidistant(const cv::Size& size, double focal_length) {
  image::LensParameters p = laparoscope(size, focal_length);
  p.distortion = image::Distortion::kEquidistant;
  p.coefficients = {-0.02, 0.006, -0.003, 0.0005};
  return p;
}

}  // namespace laparoscope_servo::test
