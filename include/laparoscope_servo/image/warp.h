// Samples an image through a homography.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/image/patch.h"

namespace laparoscope_servo::image {

// patch(j, i) = image at the point that `g` takes (i, j, 1) to, bilinear; valid(j, i) = 1 there, or 0 where that point
// lies outside the centres of the image's pixels (the patch then holds the image's first pixel). Both outputs keep
// their size, which must agree. True when every pixel is valid. Where the denominator of g is not positive, nothing is
// valid.
bool warpBilinear(const cv::Mat1f& image, const Eigen::Matrix3d& g, Patch& patch, Patch& valid);

// The same for patches without a margin.
bool warpBilinear(const cv::Mat1f& image, const Eigen::Matrix3d& g, cv::Mat1f& patch, cv::Mat1f& valid);

// The same through a lens: `g` takes the patch's pixels to rectified ones, `image` is that window of the raw image.
// What lies outside the lens's field is not valid.
bool warpBilinear(const cv::Mat1f& image, const Eigen::Matrix3d& g, const Lens& lens, const RawWindow& window,
                  Patch& patch, Patch& valid);
bool warpBilinear(const cv::Mat1f& image, const Eigen::Matrix3d& g, const Lens& lens, const RawWindow& window,
                  cv::Mat1f& patch, cv::Mat1f& valid);

// As above, sampled more slowly and more sharply (bicubic), for what is kept: a template. Pixels that are not in the
// image are that of its border.
cv::Mat1f rectify(const cv::Mat1f& image, const Eigen::Matrix3d& g, const Lens& lens, const RawWindow& window,
                  const cv::Size& size);

}  // namespace laparoscope_servo::image
