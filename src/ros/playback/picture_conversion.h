// Converts a decoded picture of a video to the pixels that a player shows: 8 bit blue-green-red, upright.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>

#include "ros/playback/libav.h"

namespace laparoscope_servo {

// Orientation of a stored picture: first transposed, then mirrored left-right, then top-bottom.
struct Orientation {
  bool transposed = false;
  bool mirrored_x = false;
  bool mirrored_y = false;
};

// From a display matrix of libavutil/display.h. Other angles are rounded to the nearest right angle.
Orientation orientationOf(const std::array<std::int32_t, 9>& display_matrix);

class PictureConverter {
 public:
  explicit PictureConverter(const Orientation& orientation) : orientation_(orientation) {}

  // Returns a new matrix of the picture's size. Uses the colour matrix and range of the picture's tags; BT.601, as in
  // ffmpeg, without tags. Throws std::runtime_error for a pixel format that swscale does not know.
  cv::Mat convert(const AVFrame& picture);

 private:
  void prepare(const AVFrame& picture);

  Orientation orientation_;
  libav::Scaler scaler_;
  std::array<int, 5> prepared_for_{};
};

}  // namespace laparoscope_servo
