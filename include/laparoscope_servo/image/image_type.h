// The image types that the package processes: 8 bit, grey (CV_8UC1) or blue-green-red (CV_8UC3).
#pragma once

#include <opencv2/core.hpp>

namespace laparoscope_servo::image {

// Throws std::invalid_argument, naming the type, for any other type.
void checkType(const cv::Mat& image);

// Of an image with its stamp, s: also where it is empty, or the stamp is not finite.
void checkImage(const cv::Mat& image, double stamp);

// Throws std::invalid_argument for a mask that is not empty and not CV_8UC1 of the image's size.
void checkMask(const cv::Mat& mask, const cv::Mat& image);

}  // namespace laparoscope_servo::image
