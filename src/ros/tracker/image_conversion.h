// Converts images to the types of the tracker: 8 bit, grey (CV_8UC1) or blue-green-red (CV_8UC3).
//
// Supported are encodings of 8 and 16 bit for grey or colour: mono8, mono16, bgr8, rgb8, bgra8, rgba8, bgr16, rgb16,
// bgra16, rgba16, 8UC1, 8UC3, 8UC4, 16UC1, 16UC3, 16UC4 (used as grey, BGR, BGRA), and YUV by the names that drivers
// use, in lower or upper case: uyvy (also yuv422), yuyv (also yuy2, yuv422_yuy2), yvyu, nv12, nv21, i420 (also yuv420,
// yuv420p), yv12. Alpha is dropped. Bayer patterns are refused: image_proc turns them into colour.
#pragma once

#include <sensor_msgs/Image.h>

#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>

namespace laparoscope_servo {

// Why an image is refused. (aesop::Refusal is that of a command.)
enum class Refusal {
  kData,    // encoding, sizes, amount of data
  kStamp,   // stamp repeated, out of order, zero, or ahead
  kSize,    // size differs from that of the last images
  kSender,  // from another node than the last images
};
constexpr Refusal kRefusals[] = {Refusal::kData, Refusal::kStamp, Refusal::kSize, Refusal::kSender};

// An unusable image; what() has the reason, with encoding and sizes, and what was expected.
class ImageError : public std::runtime_error {
 public:
  explicit ImageError(const std::string& what, Refusal cause = Refusal::kData)
      : std::runtime_error(what), cause_(cause) {}
  Refusal cause() const { return cause_; }

 private:
  Refusal cause_;
};

enum class YuvRange {
  kLimited,  // video's: Y from 16 to 235, U and V from 16 to 240
  kFull,     // JPEG's, as many webcams give it: from 0 to 255
};

struct ImageFormat {
  int bit_depth = 16;  // 8 to 16: number of low bits that 16 bit images use; the largest value becomes 255
  YuvRange yuv_range = YuvRange::kLimited;
};

// Estimates how many bits 16 bit images use: the fewest of 8, 10, 12, 14 and 16 that hold the largest value seen. Never
// decreases, so that a dark picture changes nothing.
class BitDepth {
 public:
  // Checks a quarter of the rows. Ignores images of 8 bit.
  void see(const cv::Mat& image);
  int value() const { return value_; }

 private:
  int value_ = 8;
};

// Converts the image of a message. For mono8, bgr8, 8UC1 and 8UC3 the result shares the message's data, which must
// outlive it and must not be changed; for other encodings it is a copy. Throws ImageError when the encoding is not
// among the above, the image is empty, or step or data are too small for width, height and encoding.
// `found`: if given, it is used for the bit depth instead of the format.
cv::Mat trackerImage(const sensor_msgs::Image& message, const ImageFormat& format = ImageFormat(),
                     BitDepth* found = nullptr);

// Converts an image decoded by OpenCV: 1, 3 (BGR) or 4 (BGRA) channels of 8 or 16 bit without sign. Shares the data if
// no conversion is needed. Throws ImageError for an empty image and for other types.
cv::Mat trackerImage(const cv::Mat& decoded, const ImageFormat& format = ImageFormat(), BitDepth* found = nullptr);

// Whether the encoding names a colour filter pattern, e.g. bayer_rggb8.
bool isBayer(const std::string& encoding);

}  // namespace laparoscope_servo
