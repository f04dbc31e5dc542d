#include "tracking/align/detail.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::tracking {

namespace {

constexpr int kBlock = 16;      // px
constexpr int kFewPixels = 32;  // an eighth of a block's pixels; blocks with fewer are ignored
constexpr double kBlur = 1.0;   // px

}  // namespace

double detailCorrelation(const cv::Mat1f& a, const cv::Mat1f& b, const cv::Mat1f& weight) {
  cv::Mat1f smooth_a, smooth_b;
  cv::GaussianBlur(a, smooth_a, cv::Size(), kBlur);
  cv::GaussianBlur(b, smooth_b, cv::Size(), kBlur);
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (int top = 0; top < a.rows; top += kBlock) {
    for (int left = 0; left < a.cols; left += kBlock) {
      const int bottom = std::min(top + kBlock, a.rows);
      const int right = std::min(left + kBlock, a.cols);
      double n = 0.0, sa = 0.0, sb = 0.0, sab = 0.0, saa = 0.0, sbb = 0.0;
      for (int j = top; j < bottom; ++j) {
        for (int i = left; i < right; ++i) {
          if (!(weight(j, i) > 0.0f)) continue;
          const double x = smooth_a(j, i);
          const double y = smooth_b(j, i);
          n += 1.0;
          sa += x;
          sb += y;
          sab += x * y;
          saa += x * x;
          sbb += y * y;
        }
      }
      if (n < kFewPixels) continue;
      ab += sab - sa * sb / n;
      aa += saa - sa * sa / n;
      bb += sbb - sb * sb / n;
    }
  }
  return aa > 1e-6 && bb > 1e-6 ? std::clamp(ab / std::sqrt(aa * bb), -1.0, 1.0) : 0.0;
}

}  // namespace laparoscope_servo::tracking
