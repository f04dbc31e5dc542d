#include "laparoscope_servo/image/image_type.h"

#include <stdexcept>
#include <string>

namespace laparoscope_servo::image {

void checkType(const cv::Mat& image) {
  if (image.type() == CV_8UC1 || image.type() == CV_8UC3) return;
  throw std::invalid_argument("image of OpenCV type " + std::to_string(image.type()) +
                              ", expected 8 bit with one channel or three");
}

}  // namespace laparoscope_servo::image
