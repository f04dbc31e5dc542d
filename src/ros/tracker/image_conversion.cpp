#include "ros/tracker/image_conversion.h"

#include <algorithm>
#include <boost/endian/conversion.hpp>
#include <climits>
#include <cstdint>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace laparoscope_servo {

namespace {

constexpr int kAsItIs = -1;

// Layout of the data. In 4:2:0 four pixels share a U and a V, which follow the plane of Y.
enum class Layout { kPacked, kTwoPlanes, kThreePlanes };

struct Encoding {
  const char* name;
  int depth;       // CV_8U or CV_16U
  int channels;    // channels stored per pixel; for 4:2:0, in the plane of Y
  int conversion;  // of cv::cvtColor, to grey or BGR
  Layout layout = Layout::kPacked;

  bool isYuv() const { return channels == 2 || layout != Layout::kPacked; }
};

// Uses names instead of the constants of sensor_msgs, some of which are missing in some distributions.
constexpr Encoding kEncodings[] = {
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
    {"uyvy", CV_8U, 2, cv::COLOR_YUV2BGR_UYVY},
    {"yuyv", CV_8U, 2, cv::COLOR_YUV2BGR_YUY2},
    {"yuy2", CV_8U, 2, cv::COLOR_YUV2BGR_YUY2},
    {"yvyu", CV_8U, 2, cv::COLOR_YUV2BGR_YVYU},
    {"nv12", CV_8U, 1, cv::COLOR_YUV2BGR_NV12, Layout::kTwoPlanes},
    {"nv21", CV_8U, 1, cv::COLOR_YUV2BGR_NV21, Layout::kTwoPlanes},
    {"i420", CV_8U, 1, cv::COLOR_YUV2BGR_I420, Layout::kThreePlanes},
    {"yuv420", CV_8U, 1, cv::COLOR_YUV2BGR_I420, Layout::kThreePlanes},
    {"yuv420p", CV_8U, 1, cv::COLOR_YUV2BGR_I420, Layout::kThreePlanes},
    {"yv12", CV_8U, 1, cv::COLOR_YUV2BGR_YV12, Layout::kThreePlanes},
};

std::string expectedEncodings() {
  std::string list;
  for (const Encoding& encoding : kEncodings) list += (list.empty() ? "" : ", ") + std::string(encoding.name);
  return list;
}

std::string smallLetters(std::string text) {
  for (char& letter : text) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  }
  return text;
}

const Encoding& encodingOf(const sensor_msgs::Image& message) {
  for (const Encoding& encoding : kEncodings) {
    if (message.encoding == encoding.name) return encoding;
    // Only names of YUV encodings are used in both cases by drivers; the meaning of RGB8 is unclear.
    if (encoding.isYuv() && smallLetters(message.encoding) == encoding.name) return encoding;
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
  if (encoding.isYuv() && message.width % 2 != 0) {
    throw ImageError(describe(message) + " has an odd width, expected an even one: two pixels share their colour");
  }
  const bool planes = encoding.layout != Layout::kPacked;
  if (planes && message.height % 2 != 0) {
    throw ImageError(describe(message) + " has an odd height, expected an even one: four pixels share their colour");
  }
  if (encoding.layout == Layout::kThreePlanes && message.step % 2 != 0) {
    throw ImageError(describe(message) + " has step " + std::to_string(message.step) +
                     ", expected an even one: the rows of U and V are half as long");
  }
  // The last row may lack its padding.
  const std::uint64_t rows = planes ? static_cast<std::uint64_t>(message.height) / 2 * 3 : message.height;
  const std::uint64_t last_row = encoding.layout == Layout::kThreePlanes ? row / 2 + message.step / 2 : row;
  const std::uint64_t needed = message.step * (rows - 1) + last_row;
  if (message.data.size() < needed) {
    throw ImageError(describe(message) + " with step " + std::to_string(message.step) + " is truncated: it has " +
                     std::to_string(message.data.size()) + " bytes of data, expected " +
                     std::to_string(message.step * rows));
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

cv::Mat toEightBit(const cv::Mat& image, const ImageFormat& format, BitDepth* found) {
  if (image.depth() == CV_8U) return image;
  if (found != nullptr) found->see(image);
  const int depth = found != nullptr ? found->value() : format.bit_depth;
  cv::Mat result;
  image.convertTo(result, CV_8U, 255.0 / ((1 << depth) - 1));
  return result;
}

cv::Mat converted(const cv::Mat& image, int conversion) {
  if (conversion == kAsItIs) return image;
  cv::Mat result;
  cv::cvtColor(image, result, conversion);
  return result;
}

// OpenCV only has the limited range: full-range values are converted to it, with an error of half a grey level.
const cv::Mat& limitedOf(bool luma) {
  const auto table = [](double low, double high) {
    cv::Mat result(1, 256, CV_8UC1);
    for (int k = 0; k < 256; ++k)
      result.at<std::uint8_t>(k) = cv::saturate_cast<std::uint8_t>(low + k * (high - low) / 255.0);
    return result;
  };
  static const cv::Mat of_luma = table(16.0, 235.0);
  static const cv::Mat of_colour = table(16.0, 240.0);
  return luma ? of_luma : of_colour;
}

cv::Mat limited(const cv::Mat& image, const Encoding& encoding) {
  cv::Mat result;
  if (encoding.layout == Layout::kPacked) {
    const bool luma_first = encoding.conversion != cv::COLOR_YUV2BGR_UYVY;
    cv::Mat table;
    cv::merge(std::vector<cv::Mat>{limitedOf(luma_first), limitedOf(!luma_first)}, table);
    cv::LUT(image, table, result);
    return result;
  }
  result.create(image.size(), image.type());
  const int luma_rows = image.rows / 3 * 2;
  cv::Mat luma = result.rowRange(0, luma_rows);
  cv::Mat colour = result.rowRange(luma_rows, image.rows);
  cv::LUT(image.rowRange(0, luma_rows), limitedOf(true), luma);
  cv::LUT(image.rowRange(luma_rows, image.rows), limitedOf(false), colour);
  return result;
}

// The planes of 4:2:0 below each other without gaps, as OpenCV needs them.
cv::Mat planesOf(const sensor_msgs::Image& message, const Encoding& encoding) {
  const int width = static_cast<int>(message.width);
  const int height = static_cast<int>(message.height);
  cv::Mat result(height / 2 * 3, width, CV_8UC1);
  const std::uint8_t* from = message.data.data();
  std::uint8_t* to = result.data;
  const auto copy = [&](int rows, int bytes, std::size_t step) {
    for (int row = 0; row < rows; ++row, from += step, to += bytes)
      std::memcpy(to, from, static_cast<std::size_t>(bytes));
  };
  copy(height, width, message.step);
  if (encoding.layout == Layout::kTwoPlanes) {
    copy(height / 2, width, message.step);
  } else {
    copy(height, width / 2, message.step / 2);
  }
  return result;
}

}  // namespace

bool isBayer(const std::string& encoding) {
  return encoding.compare(0, 6, "bayer_") == 0;
}

void BitDepth::see(const cv::Mat& image) {
  if (image.depth() != CV_16U || value_ == 16) return;
  double largest = 0.0;
  for (int row = 0; row < image.rows; row += 4) {
    double here = 0.0;
    cv::minMaxIdx(image.row(row).reshape(1), nullptr, &here);
    largest = std::max(largest, here);
  }
  while (value_ < 16 && largest >= static_cast<double>(1 << value_)) value_ += 2;
}

cv::Mat trackerImage(const sensor_msgs::Image& message, const ImageFormat& format, BitDepth* found) {
  const Encoding& encoding = encodingOf(message);
  checkSizes(message, encoding);
  cv::Mat image(static_cast<int>(message.height), static_cast<int>(message.width),
                CV_MAKETYPE(encoding.depth, encoding.channels), const_cast<std::uint8_t*>(message.data.data()),
                message.step);
  if (encoding.layout != Layout::kPacked) image = planesOf(message, encoding);
  if (encoding.isYuv() && format.yuv_range == YuvRange::kFull) image = limited(image, encoding);
  if (encoding.depth == CV_16U && (message.is_bigendian != 0) != hostIsBigEndian()) image = swappedBytes(image);
  return converted(toEightBit(image, format, found), encoding.conversion);
}

cv::Mat trackerImage(const cv::Mat& decoded, const ImageFormat& format, BitDepth* found) {
  if (decoded.empty()) throw ImageError("image is empty, expected at least 1x1");
  const int channels = decoded.channels();
  const bool known_depth = decoded.depth() == CV_8U || decoded.depth() == CV_16U;
  if (!known_depth || (channels != 1 && channels != 3 && channels != 4)) {
    throw ImageError("image has " + std::to_string(channels) + " channels of OpenCV's depth " +
                     std::to_string(decoded.depth()) + ", expected 1, 3 or 4 channels of 8 or 16 bit without sign");
  }
  return converted(toEightBit(decoded, format, found), channels == 4 ? static_cast<int>(cv::COLOR_BGRA2BGR) : kAsItIs);
}

}  // namespace laparoscope_servo
