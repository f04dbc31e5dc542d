// ESM as in the papers: one level, every pixel, no weights, no illumination. It is slow; tests compare esm.cpp and the
// kernels with it.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::tracking {

// G (pixels of the reference to pixels of the current image, determinant 1) after at most `iterations` steps from
// `start`, fewer if no corner of the ROI moves by more than `min_step` [px] any more. `roi` is in whole pixels of
// `reference`, and its image must lie within `current`; pixels beyond count as 0.
Eigen::Matrix3d referenceEsm(const cv::Mat1f& reference, const geometry::Rectangle& roi, const cv::Mat1f& current,
                             const Eigen::Matrix3d& start, int iterations, double min_step);

}  // namespace laparoscope_servo::tracking
