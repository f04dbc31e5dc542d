// What every image is that the package looks into: 8 bit, grey (CV_8UC1) or blue-green-red (CV_8UC3).
#pragma once

#include <opencv2/core.hpp>

namespace laparoscope_servo::image {

// Throws std::invalid_argument that names the type when it is another.
void checkType(const cv::Mat& image);

}  // namespace laparoscope_servo::image
