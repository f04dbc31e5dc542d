#include "tracking/esm/reference_esm.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "laparoscope_servo/geometry/sl3.h"
#include "tracking/esm/normal_equations.h"

namespace laparoscope_servo::tracking {

namespace {

double bilinear(const cv::Mat1f& image, const Eigen::Vector2d& p) {
  const int u = static_cast<int>(std::floor(p.x())), v = static_cast<int>(std::floor(p.y()));
  if (u < 0 || v < 0 || u + 1 >= image.cols || v + 1 >= image.rows) return 0.0;
  const double a = p.x() - u, b = p.y() - v;
  return (1.0 - b) * ((1.0 - a) * image(v, u) + a * image(v, u + 1)) +
         b * ((1.0 - a) * image(v + 1, u) + a * image(v + 1, u + 1));
}

// I(G p): the current image, warped onto the pixels of the ROI.
cv::Mat1d warped(const cv::Mat1f& current, const Eigen::Matrix3d& g, const geometry::Rectangle& roi) {
  cv::Mat1d patch(static_cast<int>(roi.height), static_cast<int>(roi.width));
  for (int j = 0; j < patch.rows; ++j) {
    for (int i = 0; i < patch.cols; ++i) {
      patch(j, i) = bilinear(current, geometry::apply(g, Eigen::Vector2d(roi.x + i, roi.y + j)));
    }
  }
  return patch;
}

// Per pixel: central differences, one-sided at the patch's border.
Eigen::Vector2d gradient(const cv::Mat1d& patch, int j, int i) {
  const int left = std::max(i - 1, 0), right = std::min(i + 1, patch.cols - 1);
  const int above = std::max(j - 1, 0), below = std::min(j + 1, patch.rows - 1);
  return {(patch(j, right) - patch(j, left)) / (right - left), (patch(below, i) - patch(above, i)) / (below - above)};
}

}  // namespace

Eigen::Matrix3d referenceEsm(const cv::Mat1f& reference, const geometry::Rectangle& roi, const cv::Mat1f& current,
                             const Eigen::Matrix3d& start, int iterations, double min_step) {
  const geometry::Sl3Steps steps(templateFromPixels(roi));
  const Eigen::Matrix3d& n = steps.normalisation();
  const cv::Mat1d t = warped(reference, Eigen::Matrix3d::Identity(), roi);
  Eigen::Matrix3d g = start;
  for (int k = 0; k < iterations; ++k) {
    const cv::Mat1d image = warped(current, g, roi);  // warp
    Matrix8d jtj = Matrix8d::Zero();
    geometry::Vector8d jtr = geometry::Vector8d::Zero();
    for (int j = 0; j < t.rows; ++j) {
      for (int i = 0; i < t.cols; ++i) {
        // The mean of both gradients makes the step second-order; a template unit is halfSize pixels.
        const Eigen::Vector2d mean = 0.5 * halfSize(roi) * (gradient(image, j, i) + gradient(t, j, i));
        const Eigen::Vector2d p = geometry::apply(n, Eigen::Vector2d(roi.x + i, roi.y + j));
        const Eigen::Matrix<double, 1, 8> row = esmJacobianRow(mean.x(), mean.y(), p.x(), p.y());  // J
        jtj += row.transpose() * row;                                                              // J'J
        jtr += row.transpose() * (image(j, i) - t(j, i));                                          // J'r
      }
    }
    const geometry::Vector8d x = -jtj.ldlt().solve(jtr);  // x = -(J'J)^-1 J'r
    const Eigen::Matrix3d next =
        geometry::normaliseDeterminant(steps.plus(g, x));  // G <- G exp(A(x)), in template units
    const double step = geometry::cornerDistance(g, next, roi);
    g = next;
    if (step < min_step) break;
  }
  return g;
}

}  // namespace laparoscope_servo::tracking
