// Samples an image through a homography.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/image/patch.h"

namespace laparoscope_servo::image {

// patch(j, i) = image at the point to which `g` takes (i, j, 1), bilinear; valid(j, i) = 1 there, or 0 if that point
// lies outside the centres of the image's pixels (the patch then holds the image's first pixel). Both outputs keep
// their size, which must agree. Returns whether all pixels are valid. Pixels are invalid where the denominator of g is
// not positive.
bool warpBilinear(const cv::Mat1f& image, const Eigen::Matrix3d& g, Patch& patch, Patch& valid);

// warpBilinear() for patches without a margin.
bool warpBilinear(const cv::Mat1f& image, const Eigen::Matrix3d& g, cv::Mat1f& patch, cv::Mat1f& valid);

// warpBilinear() through a lens: `g` takes the patch's pixels to rectified ones, `image` is that window of the raw
// image. Pixels outside the lens's field are not valid.
bool warpBilinear(const cv::Mat1f& image, const Eigen::Matrix3d& g, const Lens& lens, const RawWindow& window,
                  Patch& patch, Patch& valid);
bool warpBilinear(const cv::Mat1f& image, const Eigen::Matrix3d& g, const Lens& lens, const RawWindow& window,
                  cv::Mat1f& patch, cv::Mat1f& valid);

// As above with bicubic sampling, which is slower and sharper, for a template. Pixels outside the image take the value
// of its border.
cv::Mat1f rectify(const cv::Mat1f& image, const Eigen::Matrix3d& g, const Lens& lens, const RawWindow& window,
                  const cv::Size& size);

}  // namespace laparoscope_servo::image
