#include "laparoscope_servo/image/warp.h"

#include <algorithm>

namespace laparoscope_servo::image {

namespace {

// One row of the patch. `n`, `d`: numerators and denominator of the point at i = 0, and what they grow by with i.
struct Row {
  float u0, u1;
  float v0, v1;
  float w0, w1;
};

// Returns how many pixels are valid.
int warpRow(const float* image, int stride, int width, int height, const Row& row, int count, float* patch, float* valid) {
  const float right = static_cast<float>(width - 1);
  const float bottom = static_cast<float>(height - 1);
  const int last_column = std::max(width - 2, 0);
  const int last_row = std::max(height - 2, 0);
  const int step_right = width > 1 ? 1 : 0;
  const int step_down = height > 1 ? stride : 0;
  int inside_count = 0;
#pragma omp simd reduction(+ : inside_count)
  for (int i = 0; i < count; ++i) {
    const float x = static_cast<float>(i);
    const float w = row.w0 + row.w1 * x;
    const float u = (row.u0 + row.u1 * x) / w;
    const float v = (row.v0 + row.v1 * x) / w;
    // Comparisons that are false for NaN; bitwise, so that the loop has no branches.
    const bool inside = (u >= 0.0f) & (u <= right) & (v >= 0.0f) & (v <= bottom) & (w > 0.0f);
    const float uc = inside ? u : 0.0f;
    const float vc = inside ? v : 0.0f;
    const int iu = std::min(static_cast<int>(uc), last_column);
    const int iv = std::min(static_cast<int>(vc), last_row);
    const float fu = uc - static_cast<float>(iu);
    const float fv = vc - static_cast<float>(iv);
    const int k = iv * stride + iu;
    const float top = image[k] + fu * (image[k + step_right] - image[k]);
    const float low = image[k + step_down] + fu * (image[k + step_down + step_right] - image[k + step_down]);
    patch[i] = top + fv * (low - top);
    valid[i] = inside ? 1.0f : 0.0f;
    inside_count += inside ? 1 : 0;
  }
  return inside_count;
}

}  // namespace

bool warpBilinear(const cv::Mat1f& image, const Eigen::Matrix3d& g, cv::Mat1f& patch, cv::Mat1f& valid) {
  const int stride = static_cast<int>(image.step1());
  int inside = 0;
  for (int j = 0; j < patch.rows; ++j) {
    const Eigen::Vector3d start = g.col(1) * j + g.col(2);
    const Row row = {static_cast<float>(start[0]), static_cast<float>(g(0, 0)), static_cast<float>(start[1]),
                     static_cast<float>(g(1, 0)), static_cast<float>(start[2]), static_cast<float>(g(2, 0))};
    inside += warpRow(image.ptr<float>(), stride, image.cols, image.rows, row, patch.cols, patch.ptr<float>(j),
                      valid.ptr<float>(j));
  }
  return inside == patch.rows * patch.cols;
}

void gradients(const cv::Mat1f& patch, cv::Mat1f& gx, cv::Mat1f& gy) {
  gx.create(patch.size());
  gy.create(patch.size());
  const int width = patch.cols;
  const int height = patch.rows;
  for (int j = 0; j < height; ++j) {
    const int above = std::max(j - 1, 0);
    const int below = std::min(j + 1, height - 1);
    const float* row = patch.ptr<float>(j);
    const float* up = patch.ptr<float>(above);
    const float* down = patch.ptr<float>(below);
    float* x = gx.ptr<float>(j);
    float* y = gy.ptr<float>(j);
    const float scale = below > above ? 1.0f / static_cast<float>(below - above) : 0.0f;
    for (int i = 0; i < width; ++i) y[i] = scale * (down[i] - up[i]);
    for (int i = 1; i + 1 < width; ++i) x[i] = 0.5f * (row[i + 1] - row[i - 1]);
    x[0] = width > 1 ? row[1] - row[0] : 0.0f;
    x[width - 1] = width > 1 ? row[width - 1] - row[width - 2] : 0.0f;
  }
}

}  // namespace laparoscope_servo::image
