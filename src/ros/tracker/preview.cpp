#include "ros/tracker/preview.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace laparoscope_servo {

namespace {

cv::Size previewSize(const cv::Size& image, int most) {
  const double scale = std::min(1.0, static_cast<double>(most) / std::max(image.width, image.height));
  const auto scaled = [scale](int side) { return std::max(1, static_cast<int>(std::lround(scale * side))); };
  return {scaled(image.width), scaled(image.height)};
}

// Converts the centre of a preview pixel to image pixels, and back.
double toImage(double preview, int image_side, int preview_side) {
  return (preview + 0.5) * image_side / preview_side - 0.5;
}

}  // namespace

bool Preview::due(double now) {
  // Slots are periodic, so that of a camera at 30 Hz 25 images are shown, and not 15.
  if (now < next_) return false;
  next_ = next_ + kPreviewPeriod > now ? next_ + kPreviewPeriod : now + kPreviewPeriod;
  return true;
}

cv::Mat Preview::of(const cv::Mat& image, const std::shared_ptr<const image::Lens>& lens) {
  cv::Mat preview;
  const cv::Size size = previewSize(image.size(), side_);
  if (size == image.size()) {
    preview = image;
  } else {
    cv::resize(image, preview, size, 0.0, 0.0, cv::INTER_AREA);
  }
  if (!lens) return preview;
  prepareMap(image.size(), size, lens);
  cv::Mat rectified;
  cv::remap(preview, rectified, map_, map_weights_, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return rectified;
}

// Computes, for each pixel of the rectified preview, its place in the preview of the raw image.
void Preview::prepareMap(const cv::Size& image, const cv::Size& preview,
                         const std::shared_ptr<const image::Lens>& lens) {
  if (lens == lens_ && image == image_size_) return;
  constexpr float kNowhere = -1e4f;  // px
  cv::Mat2f map(preview);
  for (int v = 0; v < preview.height; ++v) {
    for (int u = 0; u < preview.width; ++u) {
      const auto raw = lens->toRaw({toImage(u, image.width, preview.width), toImage(v, image.height, preview.height)});
      map(v, u) = raw ? cv::Vec2f(static_cast<float>(toImage(raw->x(), preview.width, image.width)),
                                  static_cast<float>(toImage(raw->y(), preview.height, image.height)))
                      : cv::Vec2f(kNowhere, kNowhere);
    }
  }
  cv::convertMaps(map, cv::noArray(), map_, map_weights_, CV_16SC2);
  lens_ = lens;
  image_size_ = image;
}

}  // namespace laparoscope_servo
