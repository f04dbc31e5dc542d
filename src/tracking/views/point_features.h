// Draws points with descriptors from a coarse image.
//
// Of what OpenCV has without further modules, SIFT finds the most regions of tissue again, for each image and for each
// millisecond (see bench_search); OpenCV has it among its features since 4.4. Before, AKAZE is the next best. Both take
// thresholds far below those made for photographs.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace laparoscope_servo::tracking {

// Points with a descriptor each, a row of `descriptors`.
struct DescribedPoints {
  std::vector<cv::Point2f> points;  // px, of the image that they were drawn from; with a lens rectified ones
  cv::Mat descriptors;
};

// About the `count` strongest of `grey`, where `mask` is not 0; in its pixels.
DescribedPoints drawPoints(const cv::Mat1b& grey, const cv::Mat1b& mask, int count);

// How much the descriptors differ, those of `a` in rows, of `b` in columns. Neither may be empty.
cv::Mat1f descriptorDistances(const DescribedPoints& a, const DescribedPoints& b);

}  // namespace laparoscope_servo::tracking
