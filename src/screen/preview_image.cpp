#include "screen/preview_image.h"

#include <sensor_msgs/image_encodings.h>

#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::screen {

QImage previewImage(const sensor_msgs::Image& message) {
  constexpr std::uint32_t kLargest = 8192;  // px of a side: larger than any preview
  const bool colour = message.encoding == sensor_msgs::image_encodings::BGR8;
  if (!colour && message.encoding != sensor_msgs::image_encodings::MONO8) return {};
  const std::uint32_t row = message.width * (colour ? 3u : 1u);
  if (message.width < 1 || message.height < 1 || message.width > kLargest || message.height > kLargest) return {};
  if (message.step < row || message.data.size() / message.step < message.height) return {};
  const int width = static_cast<int>(message.width);
  const int height = static_cast<int>(message.height);
  // OpenCV has no const view of data; this one is not written to.
  const cv::Mat source(height, width, colour ? CV_8UC3 : CV_8UC1, const_cast<std::uint8_t*>(message.data.data()),
                       message.step);
  QImage image(width, height, QImage::Format_RGB32);
  if (image.isNull()) return {};
  cv::Mat target(height, width, CV_8UC4, image.bits(), static_cast<std::size_t>(image.bytesPerLine()));
  cv::cvtColor(source, target, colour ? cv::COLOR_BGR2BGRA : cv::COLOR_GRAY2BGRA);
  return image;
}

}  // namespace laparoscope_servo::screen
