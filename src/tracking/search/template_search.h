// Template search: finds places to start ESM when the region of interest (ROI) was lost.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/pyramid.h"

namespace laparoscope_servo::tracking {

struct Candidate {
  Eigen::Matrix3d g;   // reference to current pixels, determinant 1
  double score = 0.0;  // zero-mean normalised cross-correlation at the coarse level, -1 to 1
};

// Slides the ROI, warped by `last` (scale and perspective about its centre), over the whole coarse image and returns
// the `count` best separate places, best first. `reference` is the ROI of the reference at the pyramid's level `level`
// and `reference_T_patch` takes its pixels to the reference's; `image` is that level of the whole current image, its
// first pixel on the image's.
std::vector<Candidate> templateSearch(const cv::Mat1f& reference, const Eigen::Matrix3d& reference_T_patch,
                                      const cv::Mat1f& image, double scale, const geometry::Rectangle& roi,
                                      const Eigen::Matrix3d& last, int count);

}  // namespace laparoscope_servo::tracking
