// Whether two patches show the same tissue, by their fine structure alone.
#pragma once

#include <opencv2/core.hpp>

namespace laparoscope_servo::tracking {

// Correlation of two patches of one size, -1 to 1, after a slight blur (noise) and after the mean of each block of 16 x
// 16 px was taken away (shading, shadows, edges of large things: what makes wrong places correlate). Over the pixels of
// positive weight; blocks with few of them do not count. 0 where nothing is left or a side is constant.
double detailCorrelation(const cv::Mat1f& a, const cv::Mat1f& b, const cv::Mat1f& weight);

}  // namespace laparoscope_servo::tracking
