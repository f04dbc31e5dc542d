#include "laparoscope_servo/image/image_type.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace laparoscope_servo::image {

void checkType(const cv::Mat& image) {
  if (image.type() == CV_8UC1 || image.type() == CV_8UC3) return;
  throw std::invalid_argument("image of OpenCV type " + std::to_string(image.type()) +
                              ", expected 8 bit with one channel or three");
}

void checkImage(const cv::Mat& image, double stamp) {
  if (image.empty()) throw std::invalid_argument("image of 0 x 0 px, expected pixels");
  checkType(image);
  if (!std::isfinite(stamp)) throw std::invalid_argument("stamp is not finite, expected seconds");
}

void checkMask(const cv::Mat& mask, const cv::Mat& image) {
  if (mask.empty() || (mask.type() == CV_8UC1 && mask.size() == image.size())) return;
  std::ostringstream text;
  text << "external mask of " << mask.cols << " x " << mask.rows << " px and OpenCV type " << mask.type()
       << ", expected the image's size, " << image.cols << " x " << image.rows << " px, and type " << CV_8UC1;
  throw std::invalid_argument(text.str());
}

}  // namespace laparoscope_servo::image
