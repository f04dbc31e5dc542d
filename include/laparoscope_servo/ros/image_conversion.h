// From images as they come to what the tracker takes: 8 bit, grey (CV_8UC1) or blue-green-red (CV_8UC3).
//
// Understood are the encodings of 8 and 16 bit that stand for grey or colour: mono8, mono16, bgr8, rgb8, bgra8, rgba8,
// bgr16, rgb16, bgra16, rgba16, 8UC1, 8UC3, 8UC4, 16UC1, 16UC3, 16UC4 (without a name for the channels: taken for grey,
// BGR, BGRA), and yuv422 (UYVY), yuv422_yuy2 (YUYV). Of 16 bit the full range is taken: 65535 becomes 255, values are
// divided by 257. Alpha is dropped. Bayer patterns are refused: image_proc turns them into colour.
#pragma once

#include <sensor_msgs/Image.h>

#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>

namespace laparoscope_servo::skin {

// An image that cannot be used; what() says why, with the encoding and the sizes, and what was expected.
class ImageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The image of a message. For mono8, bgr8, 8UC1 and 8UC3 it shares the message's data, which therefore has to outlive
// it and must not be written to; for the others it is a copy. Throws ImageError when the encoding is not among the
// above, the image is empty, or step or data are too small for width, height and encoding.
cv::Mat trackerImage(const sensor_msgs::Image& message);

// The same for an image decoded by OpenCV: 1, 3 (BGR) or 4 (BGRA) channels of 8 or 16 bit without sign. Shares the data
// when nothing has to be done. Throws ImageError for an empty one and for other types.
cv::Mat trackerImage(const cv::Mat& decoded);

// Whether the encoding names a colour filter pattern, e.g. bayer_rggb8.
bool isBayer(const std::string& encoding);

}  // namespace laparoscope_servo::skin
