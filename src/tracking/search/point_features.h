// Draws points with descriptors from a coarse image.
//
// Of what OpenCV has without further modules, SIFT finds the most regions of tissue again, for each image and for each
// millisecond (see bench_search); OpenCV has it among its features since 4.4. Before, AKAZE is the next best. Both take
// thresholds far below those made for photographs.
#pragma once

#include <opencv2/core.hpp>

#include "tracking/views/features.h"

namespace laparoscope_servo::tracking {

// About the `count` strongest of `grey`, where `mask` is not 0; in its pixels.
Features drawPoints(const cv::Mat1b& grey, const cv::Mat1b& mask, int count);

// How much the descriptors differ, those of `a` in rows, of `b` in columns. Neither may be empty.
cv::Mat1f descriptorDistances(const Features& a, const Features& b);

}  // namespace laparoscope_servo::tracking
