#include "ros/common/picture_file.h"

#include <opencv2/imgcodecs.hpp>

namespace laparoscope_servo {

cv::Mat readPicture(const std::string& file, int flags) {
  try {
    return cv::imread(file, flags);
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace laparoscope_servo
