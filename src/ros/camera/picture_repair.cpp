#include "ros/camera/picture_repair.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

namespace laparoscope_servo {

namespace {

// OpenCV names a pattern by the second and third pixel of the second line.
int conversionOf(BayerPattern pattern) {
  switch (pattern) {
    case BayerPattern::kRggb:
      return cv::COLOR_BayerBG2BGR;
    case BayerPattern::kBggr:
      return cv::COLOR_BayerRG2BGR;
    case BayerPattern::kGbrg:
      return cv::COLOR_BayerGR2BGR;
    default:
      return cv::COLOR_BayerGB2BGR;
  }
}

// Its channels are the same but for what a video's codec makes of them.
bool isGrey(const cv::Mat& picture) {
  constexpr double kCodec = 4.0;  // grey levels
  cv::Mat blue, green, red;
  cv::extractChannel(picture, blue, 0);
  cv::extractChannel(picture, green, 1);
  cv::extractChannel(picture, red, 2);
  return cv::norm(blue, green, cv::NORM_INF) <= kCodec && cv::norm(green, red, cv::NORM_INF) <= kCodec;
}

}  // namespace

cv::Mat colourOf(const cv::Mat& raw, BayerPattern pattern) {
  if (pattern == BayerPattern::kNone) return raw;
  if ((raw.type() != CV_8UC1 && raw.type() != CV_8UC3) || raw.rows < 2 || raw.cols < 2) {
    throw std::invalid_argument("a picture of " + std::to_string(raw.cols) + "x" + std::to_string(raw.rows) + " px, " +
                                std::to_string(raw.channels()) + " channels, depth " + std::to_string(raw.depth()) +
                                " is no Bayer pattern, expected 8 bit and one channel");
  }
  cv::Mat mosaic = raw;
  if (raw.channels() == 3) {
    if (!isGrey(raw)) {
      throw std::invalid_argument("a picture that is in colour already is no Bayer pattern, expected bayer = none");
    }
    cv::extractChannel(raw, mosaic, 0);
  }
  cv::Mat colour;
  cv::cvtColor(mosaic, colour, conversionOf(pattern));
  return colour;
}

cv::Mat deinterlaced(const cv::Mat& picture, Interlacing interlacing) {
  if (interlacing == Interlacing::kNone || picture.rows < 2) return picture;
  cv::Mat result = picture.clone();
  const int last = picture.rows - 1;
  for (int y = interlacing == Interlacing::kUpper ? 1 : 0; y <= last; y += 2) {
    const int above = y > 0 ? y - 1 : y + 1;
    const int below = y < last ? y + 1 : y - 1;
    cv::Mat line = result.row(y);
    cv::addWeighted(picture.row(above), 0.5, picture.row(below), 0.5, 0.0, line);
  }
  return result;
}

}  // namespace laparoscope_servo
