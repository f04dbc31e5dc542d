// Samples an image through a homography.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "laparoscope_servo/image/patch.h"

namespace laparoscope_servo::image {

// patch(j, i) = image at the point that `g` takes (i, j, 1) to, bilinear; valid(j, i) = 1 there, or 0 where that point lies
// outside the centres of the image's pixels (the patch then holds the image's first pixel). Both outputs keep their size, which
// must agree. True when every pixel is valid. Where the denominator of g is not positive, nothing is valid.
bool warpBilinear(const cv::Mat1f& image, const Eigen::Matrix3d& g, Patch& patch, Patch& valid);

// The same for patches without a margin.
bool warpBilinear(const cv::Mat1f& image, const Eigen::Matrix3d& g, cv::Mat1f& patch, cv::Mat1f& valid);

}  // namespace laparoscope_servo::image
