// The colours of a region of interest (ROI) as seen in an image, for what is decided per pixel rather than interpolated.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace laparoscope_servo::image {

// patch(j, i) = the image's pixel nearest to the point that `g` takes (i, j, 1) to; valid(j, i) = 255 there, 0 where that lies
// outside the image (the patch is then black). `image` is CV_8UC1 or CV_8UC3, `patch` gets its type; both get `size`.
void warpNearest(const cv::Mat& image, const Eigen::Matrix3d& g, const cv::Size& size, cv::Mat& patch, cv::Mat1b& valid);

// 255 where any channel is at least `threshold` (grey levels), grown by `grow` px in every direction; 0 elsewhere. CV_8UC1 or
// CV_8UC3. Highlights move with the lamp rather than with the tissue, and their rims are bleached.
void saturatedPixels(const cv::Mat& patch, int threshold, int grow, cv::Mat1b& mask);

}  // namespace laparoscope_servo::image
