// Measures whether two patches show the same tissue, by their fine structure alone.
#pragma once

#include <opencv2/core.hpp>

namespace laparoscope_servo::tracking {

// Correlation of two patches of one size, -1 to 1, after a slight blur (against noise) and after subtraction of the
// mean of each block of 16 x 16 px, because shading, shadows and edges of large objects also correlate at wrong places.
// Uses the pixels of positive weight; blocks with few of them are ignored. 0 if no pixels remain or a patch is
// constant.
double detailCorrelation(const cv::Mat1f& a, const cv::Mat1f& b, const cv::Mat1f& weight);

}  // namespace laparoscope_servo::tracking
