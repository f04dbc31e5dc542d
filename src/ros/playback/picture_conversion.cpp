#include "ros/playback/picture_conversion.h"

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace laparoscope_servo {

namespace {

constexpr int kAlignment = 32;  // pixels: largest block in which swscale's kernels write rows

std::string formatName(int format) {
  const char* name = av_get_pix_fmt_name(static_cast<AVPixelFormat>(format));
  return name != nullptr ? name : "number " + std::to_string(format);
}

// Sets colour matrix and range, for which swscale by default takes BT.601 and the range of the pixel format.
void tellColours(SwsContext* scaler, const AVFrame& picture) {
  int* from = nullptr;
  int* to = nullptr;
  int from_full = 0;
  int to_full = 0;
  int brightness = 0;
  int contrast = 0;
  int saturation = 0;
  if (sws_getColorspaceDetails(scaler, &from, &from_full, &to, &to_full, &brightness, &contrast, &saturation) < 0) {
    return;  // RGB: a format without a matrix
  }
  const bool full = from_full != 0 || picture.color_range == AVCOL_RANGE_JPEG;
  const int* matrix = from;
  switch (picture.colorspace) {
    case AVCOL_SPC_BT709:
      matrix = sws_getCoefficients(SWS_CS_ITU709);
      break;
    case AVCOL_SPC_FCC:
      matrix = sws_getCoefficients(SWS_CS_FCC);
      break;
    case AVCOL_SPC_SMPTE240M:
      matrix = sws_getCoefficients(SWS_CS_SMPTE240M);
      break;
    case AVCOL_SPC_BT2020_NCL:
    case AVCOL_SPC_BT2020_CL:
      matrix = sws_getCoefficients(SWS_CS_BT2020);
      break;
    default:
      break;
  }
  if (matrix == from && full == (from_full != 0)) return;
  sws_setColorspaceDetails(scaler, matrix, full ? 1 : 0, to, to_full, brightness, contrast, saturation);
}

}  // namespace

Orientation orientationOf(const std::array<std::int32_t, 9>& m) {
  // A pixel (x, y) is shown at (m0 x + m3 y, m1 x + m4 y).
  const auto size = [&m](std::size_t k) { return std::llabs(m[k]); };
  if (size(1) + size(3) > size(0) + size(4)) return {true, m[3] < 0, m[1] < 0};
  return {false, m[0] < 0, m[4] < 0};
}

void PictureConverter::prepare(const AVFrame& picture) {
  const std::array<int, 5> wanted{picture.width, picture.height, picture.format, picture.colorspace,
                                  picture.color_range};
  if (scaler_ && wanted == prepared_for_) return;
  scaler_.reset(sws_getContext(picture.width, picture.height, static_cast<AVPixelFormat>(picture.format), picture.width,
                               picture.height, AV_PIX_FMT_BGR24, SWS_BICUBIC, nullptr, nullptr, nullptr));
  if (!scaler_) {
    throw std::runtime_error("pixel format " + formatName(picture.format) + " of " + std::to_string(picture.width) +
                             "x" + std::to_string(picture.height) + " px cannot be converted");
  }
  tellColours(scaler_.get(), picture);
  prepared_for_ = wanted;
}

cv::Mat PictureConverter::convert(const AVFrame& picture) {
  prepare(picture);
  const int padded_width = (picture.width + kAlignment - 1) / kAlignment * kAlignment;
  const cv::Mat padded(picture.height, padded_width, CV_8UC3);
  std::uint8_t* const rows[] = {padded.data};
  const int steps[] = {static_cast<int>(padded.step)};
  if (sws_scale(scaler_.get(), picture.data, picture.linesize, 0, picture.height, rows, steps) != picture.height) {
    throw std::runtime_error("pixel format " + formatName(picture.format) + " cannot be converted");
  }
  cv::Mat image = padded.colRange(0, picture.width);
  if (orientation_.transposed) image = image.t();
  if (orientation_.mirrored_x || orientation_.mirrored_y) {
    cv::Mat flipped;
    cv::flip(image, flipped, orientation_.mirrored_x ? (orientation_.mirrored_y ? -1 : 1) : 0);
    return flipped;
  }
  return image.isContinuous() ? image : image.clone();
}

}  // namespace laparoscope_servo
