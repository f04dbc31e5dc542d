// Images and motions that need no file.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <random>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::bench {

// CV_8UC3: reddish noise of several scales, as tissue has. The same for the same seed.
cv::Mat syntheticTissue(const cv::Size& size, unsigned seed);

// The image as seen when what was at p is at g p, with independent normal noise of `noise` grey levels in each channel.
cv::Mat view(const cv::Mat& image, const Eigen::Matrix3d& g, double noise, std::mt19937& random);

// The homography that displaces each coordinate of the ROI's corners by normal noise of `sigma` px, drawn again until
// the corners are convex; determinant 1.
Eigen::Matrix3d displacedCorners(const geometry::Rectangle& roi, double sigma, std::mt19937& random);

// A shift by `distance` px in a random direction.
Eigen::Matrix3d displaced(double distance, std::mt19937& random);

// The square of `side` px in the middle of the ROI.
geometry::Rectangle middle(const geometry::Rectangle& roi, double side);

}  // namespace laparoscope_servo::bench
