// Pictures of files that somebody else wrote.
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace laparoscope_servo {

// cv::imread(file, flags), but empty also for a file that claims more pixels than OpenCV takes: that one throws.
cv::Mat readPicture(const std::string& file, int flags);

}  // namespace laparoscope_servo
