#include "laparoscope_servo/image/colour_patch.h"

#include <algorithm>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace laparoscope_servo::image {

void warpNearest(const cv::Mat& image, const Eigen::Matrix3d& g, const cv::Size& size, cv::Mat& patch, cv::Mat1b& valid) {
  if (image.type() != CV_8UC1 && image.type() != CV_8UC3) {
    throw std::invalid_argument("image of OpenCV type " + std::to_string(image.type()) +
                                ", expected 8 bit with one channel or three");
  }
  patch.create(size, image.type());
  valid.create(size);
  const int channels = image.channels();
  const float right = static_cast<float>(image.cols) - 0.5f;
  const float bottom = static_cast<float>(image.rows) - 0.5f;
  for (int j = 0; j < size.height; ++j) {
    const Eigen::Vector3f start = (g.col(1) * j + g.col(2)).cast<float>();
    const Eigen::Vector3f step = g.col(0).cast<float>();
    unsigned char* to = patch.ptr<unsigned char>(j);
    unsigned char* ok = valid.ptr<unsigned char>(j);
    for (int i = 0; i < size.width; ++i, to += channels) {
      const float x = static_cast<float>(i);
      const float w = start[2] + step[2] * x;
      const float u = (start[0] + step[0] * x) / w;
      const float v = (start[1] + step[1] * x) / w;
      const bool inside = w > 0.0f && u > -0.5f && u < right && v > -0.5f && v < bottom;
      ok[i] = inside ? 255 : 0;
      if (!inside) {
        std::memset(to, 0, channels);
        continue;
      }
      const int column = std::min(static_cast<int>(u + 0.5f), image.cols - 1);
      const int row = std::min(static_cast<int>(v + 0.5f), image.rows - 1);
      std::memcpy(to, image.ptr<unsigned char>(row) + channels * column, channels);
    }
  }
}

void saturatedPixels(const cv::Mat& patch, int threshold, int grow, cv::Mat1b& mask) {
  mask.create(patch.size());
  const int channels = patch.channels();
  bool any = false;
  for (int j = 0; j < patch.rows; ++j) {
    const unsigned char* from = patch.ptr<unsigned char>(j);
    unsigned char* to = mask.ptr<unsigned char>(j);
    for (int i = 0; i < patch.cols; ++i) {
      int brightest = from[channels * i];
      for (int c = 1; c < channels; ++c) brightest = std::max<int>(brightest, from[channels * i + c]);
      to[i] = brightest >= threshold ? 255 : 0;
      any |= brightest >= threshold;
    }
  }
  if (any && grow > 0) {
    cv::dilate(mask, mask, cv::getStructuringElement(cv::MORPH_RECT, cv::Size(2 * grow + 1, 2 * grow + 1)));
  }
}

}  // namespace laparoscope_servo::image
