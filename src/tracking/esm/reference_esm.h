// ESM as the papers write it: one level, every pixel, nothing but the equations. It is slow, and what esm.cpp and the
// kernels do must come to the same: their tests compare.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::tracking {

// G (pixels of the reference to pixels of the current image, determinant 1) after at most `iterations` steps from
// `start`, fewer when no corner of the ROI moves by more than `min_step` [px] any more. `roi` is in whole pixels of
// `reference`, and its image lies within `current`: what is beyond is taken for 0.
Eigen::Matrix3d referenceEsm(const cv::Mat1f& reference, const geometry::Rectangle& roi, const cv::Mat1f& current,
                             const Eigen::Matrix3d& start, int iterations, double min_step);

}  // namespace laparoscope_servo::tracking
