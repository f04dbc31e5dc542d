// Converts colour filter patterns to colour, and removes interlacing.
#pragma once

#include <opencv2/core.hpp>

namespace laparoscope_servo {

// The colours of the first two pixels of the first two lines, with the names of ROS: bayer_rggb8.
enum class BayerPattern { kNone, kRggb, kBggr, kGbrg, kGrbg };

enum class Interlacing {
  kNone,
  kUpper,  // the lines 0, 2, 4 ... are kept
  kLower,  // the lines 1, 3, 5 ... are kept
};

// Converts a raw picture to blue-green-red. `raw`: 8 bit, one channel; with three, as from decoders of grey video, the
// first is used. Throws std::invalid_argument for other types, for what is in colour already and for pictures below 2x2
// px.
cv::Mat colourOf(const cv::Mat& raw, BayerPattern pattern);

// Keeps one half picture in full size; the lines of the other one, taken some 20 ms earlier or later, are interpolated.
cv::Mat deinterlaced(const cv::Mat& picture, Interlacing interlacing);

}  // namespace laparoscope_servo
