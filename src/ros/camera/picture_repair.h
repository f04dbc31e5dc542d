// What cameras and grabbers do to pictures, undone: colour filters, half pictures.
#pragma once

#include <opencv2/core.hpp>

namespace laparoscope_servo {

// The colours of the first two pixels of the first two lines, as ROS names them: bayer_rggb8.
enum class BayerPattern { kNone, kRggb, kBggr, kGbrg, kGrbg };

enum class Interlacing {
  kNone,
  kUpper,  // the lines 0, 2, 4 ... are kept
  kLower,  // the lines 1, 3, 5 ... are kept
};

// Blue-green-red of what the sensor saw. `raw`: 8 bit, one channel; of three, as decoders make of grey, the first one
// is taken. Throws std::invalid_argument for other types and for pictures below 2x2 px.
cv::Mat colourOf(const cv::Mat& raw, BayerPattern pattern);

// One half picture in full size: the lines of the other one, seen some 20 ms earlier or later, are interpolated.
cv::Mat deinterlaced(const cv::Mat& picture, Interlacing interlacing);

}  // namespace laparoscope_servo
