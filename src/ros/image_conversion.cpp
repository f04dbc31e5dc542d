#include "laparoscope_servo/ros/image_conversion.h"

#include <array>
#include <boost/endian/conversion.hpp>
#include <climits>
#include <cstdint>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace laparoscope_servo::skin {

namespace {

constexpr int kAsItIs = -1;

struct Encoding {
  const char* name;
  int depth;       // CV_8U or CV_16U
  int channels;    // stored per pixel
  int conversion;  // of cv::cvtColor, to grey or BGR
};

// By names rather than constants of sensor_msgs: not every distribution has all of them.
constexpr std::array<Encoding, 18> kEncodings{{
    {"mono8", CV_8U, 1, kAsItIs},
    {"bgr8", CV_8U, 3, kAsItIs},
    {"rgb8", CV_8U, 3, cv::COLOR_RGB2BGR},
    {"bgra8", CV_8U, 4, cv::COLOR_BGRA2BGR},
    {"rgba8", CV_8U, 4, cv::COLOR_RGBA2BGR},
    {"mono16", CV_16U, 1, kAsItIs},
    {"bgr16", CV_16U, 3, kAsItIs},
    {"rgb16", CV_16U, 3, cv::COLOR_RGB2BGR},
    {"bgra16", CV_16U, 4, cv::COLOR_BGRA2BGR},
    {"rgba16", CV_16U, 4, cv::COLOR_RGBA2BGR},
    {"8UC1", CV_8U, 1, kAsItIs},
    {"8UC3", CV_8U, 3, kAsItIs},
    {"8UC4", CV_8U, 4, cv::COLOR_BGRA2BGR},
    {"16UC1", CV_16U, 1, kAsItIs},
    {"16UC3", CV_16U, 3, kAsItIs},
    {"16UC4", CV_16U, 4, cv::COLOR_BGRA2BGR},
    {"yuv422", CV_8U, 2, cv::COLOR_YUV2BGR_UYVY},
    {"yuv422_yuy2", CV_8U, 2, cv::COLOR_YUV2BGR_YUY2},
}};

std::string expectedEncodings() {
  std::string list;
  for (const Encoding& encoding : kEncodings) list += (list.empty() ? "" : ", ") + std::string(encoding.name);
  return list;
}

const Encoding& encodingOf(const sensor_msgs::Image& message) {
  for (const Encoding& encoding : kEncodings) {
    if (message.encoding == encoding.name) return encoding;
  }
  if (isBayer(message.encoding)) {
    throw ImageError("image has encoding '" + message.encoding +
                     "', a colour filter pattern; expected grey or colour: let image_proc turn it into colour (its "
                     "debayer nodelet, topic image_color)");
  }
  throw ImageError("image has encoding '" + message.encoding + "', expected one of: " + expectedEncodings());
}

std::string describe(const sensor_msgs::Image& message) {
  return "image of " + std::to_string(message.width) + "x" + std::to_string(message.height) + " " + message.encoding;
}

void checkSizes(const sensor_msgs::Image& message, const Encoding& encoding) {
  if (message.width == 0 || message.height == 0) {
    throw ImageError(describe(message) + " is empty, expected at least 1x1");
  }
  if (message.width > INT_MAX || message.height > INT_MAX) throw ImageError(describe(message) + " is too large");
  const std::uint64_t channel_bytes = encoding.depth == CV_16U ? 2 : 1;
  const std::uint64_t row = channel_bytes * encoding.channels * message.width;
  if (message.step < row) {
    throw ImageError(describe(message) + " has step " + std::to_string(message.step) + ", expected at least " +
                     std::to_string(row) + " bytes a row");
  }
  if (message.step % channel_bytes != 0) {
    throw ImageError(describe(message) + " has step " + std::to_string(message.step) +
                     ", expected an even one for 16 bit");
  }
  if (encoding.channels == 2 && message.width % 2 != 0) {
    throw ImageError(describe(message) + " has an odd width, expected an even one: two pixels share their colour");
  }
  // The last row may lack its padding.
  const std::uint64_t needed = static_cast<std::uint64_t>(message.step) * (message.height - 1) + row;
  if (message.data.size() < needed) {
    throw ImageError(describe(message) + " with step " + std::to_string(message.step) + " is truncated: it has " +
                     std::to_string(message.data.size()) + " bytes of data, expected " +
                     std::to_string(static_cast<std::uint64_t>(message.step) * message.height));
  }
}

bool hostIsBigEndian() {
  return boost::endian::order::native == boost::endian::order::big;
}

cv::Mat swappedBytes(const cv::Mat& image) {
  cv::Mat result = image.clone();
  const int values = result.cols * result.channels();
  for (int row = 0; row < result.rows; ++row) {
    auto* value = result.ptr<std::uint16_t>(row);
    for (int k = 0; k < values; ++k) value[k] = boost::endian::endian_reverse(value[k]);
  }
  return result;
}

cv::Mat toEightBit(const cv::Mat& image) {
  if (image.depth() == CV_8U) return image;
  cv::Mat result;
  image.convertTo(result, CV_8U, 1.0 / 257.0);
  return result;
}

cv::Mat converted(const cv::Mat& image, int conversion) {
  const cv::Mat eight_bit = toEightBit(image);
  if (conversion == kAsItIs) return eight_bit;
  cv::Mat result;
  cv::cvtColor(eight_bit, result, conversion);
  return result;
}

}  // namespace

bool isBayer(const std::string& encoding) {
  return encoding.compare(0, 6, "bayer_") == 0;
}

cv::Mat trackerImage(const sensor_msgs::Image& message) {
  const Encoding& encoding = encodingOf(message);
  checkSizes(message, encoding);
  cv::Mat image(static_cast<int>(message.height), static_cast<int>(message.width),
                CV_MAKETYPE(encoding.depth, encoding.channels), const_cast<std::uint8_t*>(message.data.data()),
                message.step);
  if (encoding.depth == CV_16U && (message.is_bigendian != 0) != hostIsBigEndian()) image = swappedBytes(image);
  return converted(image, encoding.conversion);
}

cv::Mat trackerImage(const cv::Mat& decoded) {
  if (decoded.empty()) throw ImageError("image is empty, expected at least 1x1");
  const int channels = decoded.channels();
  const bool known_depth = decoded.depth() == CV_8U || decoded.depth() == CV_16U;
  if (!known_depth || (channels != 1 && channels != 3 && channels != 4)) {
    throw ImageError("image has " + std::to_string(channels) + " channels of OpenCV's depth " +
                     std::to_string(decoded.depth()) + ", expected 1, 3 or 4 channels of 8 or 16 bit without sign");
  }
  return converted(decoded, channels == 4 ? static_cast<int>(cv::COLOR_BGRA2BGR) : kAsItIs);
}

}  // namespace laparoscope_servo::skin
