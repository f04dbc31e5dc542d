// Detects points in a coarse image and computes their descriptors.
//
// Among OpenCV's detectors without contrib modules, SIFT finds the most regions of tissue again, per image and per
// millisecond (see bench_search). OpenCV has it in features2d since 4.4; with older versions AKAZE, the next best, is
// used. Both get thresholds far below those for photographs.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace laparoscope_servo::features {

// Points; row k of `descriptors` belongs to point k.
struct DescribedPoints {
  std::vector<cv::Point2f> points;  // px of the image in which they were detected; with a lens rectified
  cv::Mat descriptors;
};

// About the `count` strongest points of `grey` where `mask` is not 0, in pixels of `grey`.
DescribedPoints drawPoints(const cv::Mat1b& grey, const cv::Mat1b& mask, int count);

// Distances of the descriptors of `a` (rows) and `b` (columns). Neither may be empty.
cv::Mat1f descriptorDistances(const DescribedPoints& a, const DescribedPoints& b);

}  // namespace laparoscope_servo::features
