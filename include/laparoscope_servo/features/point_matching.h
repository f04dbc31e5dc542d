// Matches the described points of two pictures, and finds the motion on which most matches agree.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "laparoscope_servo/features/described_points.h"

namespace laparoscope_servo::features {

// Pairs of indices into `a` and `b`: each is the other's nearest, and the second nearest of `b` is further off by a
// factor of 1 / max_ratio.
std::vector<std::pair<int, int>> matchPoints(const DescribedPoints& a, const DescribedPoints& b, double max_ratio);

struct AgreedMotion {
  Eigen::Matrix3d motion;  // takes the points of `from` to those of `to`
  int inliers = 0;         // that agree with it
};

// The similarity on which most agree within `inlier` px, and with 30 matches or more also the homography; those with
// fewer than `min_inliers` are left out. With few matches a fit of eight parameters is unstable.
std::vector<AgreedMotion> agreedMotions(const std::vector<cv::Point2f>& from, const std::vector<cv::Point2f>& to,
                                        double inlier, int min_inliers);

}  // namespace laparoscope_servo::features
