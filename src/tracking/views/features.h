// Points of an image that can be recognised in another.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace laparoscope_servo::tracking {

// Points with a descriptor each, a row of `descriptors`.
struct Features {
  std::vector<cv::Point2f> points;  // px, of the image that they were drawn from; with a lens rectified ones
  cv::Mat descriptors;
};

}  // namespace laparoscope_servo::tracking
