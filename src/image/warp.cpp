#include "laparoscope_servo/image/warp.h"

#include <algorithm>
#include <cstring>
#include <opencv2/imgproc.hpp>

#include "image/kernel_parts.h"
#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::image {

namespace {

using Row = ProjectiveRow;

// pixels of a row that are processed at once, so that intermediate values stay in the cache
constexpr int kChunk = 256;

// Computes the Neighbours of each pixel. Returns how many pixels lie inside.
LAPAROSCOPE_SERVO_CLONES
int locate(const Row& row, int stride, int width, int height, int first, int count, int* __restrict offset,
           float* __restrict right_of, float* __restrict below, float* __restrict valid) {
  const PixelFrame frame(width, height, stride);
  const Row r = row;
  int inside_count = 0;
#pragma omp simd reduction(+ : inside_count)
  for (int i = 0; i < count; ++i) {
    const auto [u, v, w] = pointOf(r, static_cast<float>(first + i));
    const Neighbours n = neighboursOf(frame, u, v);
    const int inside = n.inside & static_cast<int>(w > 0.0f);
    right_of[i] = n.right_of;
    below[i] = n.below;
    offset[i] = n.offset;
    valid[i] = static_cast<float>(inside);
    inside_count += inside;
  }
  return inside_count;
}

// locate() for points computed by locateRaw.
LAPAROSCOPE_SERVO_CLONES
int place(const float* __restrict u, const float* __restrict v, int stride, int width, int height, int count,
          int* __restrict offset, float* __restrict right_of, float* __restrict below, float* __restrict valid) {
  const PixelFrame frame(width, height, stride);
  int inside_count = 0;
#pragma omp simd reduction(+ : inside_count)
  for (int i = 0; i < count; ++i) {
    const Neighbours n = neighboursOf(frame, u[i], v[i]);
    right_of[i] = n.right_of;
    below[i] = n.below;
    offset[i] = n.offset;
    valid[i] = static_cast<float>(n.inside);
    inside_count += n.inside;
  }
  return inside_count;
}

// Copies the pair of pixels at each offset, and the pair below. Four pairs are stored at once: a fifth less time.
LAPAROSCOPE_SERVO_CLONES
void gather(const float* pixels, int step_down, const int* __restrict offset, int count, float* __restrict upper,
            float* __restrict lower) {
  constexpr int kPairs = 4;
  constexpr std::size_t kPair = 2 * sizeof(float);
  const float* const below = pixels + step_down;
  int i = 0;
  for (; i + kPairs <= count; i += kPairs) {
    float up[2 * kPairs], low[2 * kPairs];
    for (int k = 0; k < kPairs; ++k) {
      std::memcpy(up + 2 * k, pixels + offset[i + k], kPair);
      std::memcpy(low + 2 * k, below + offset[i + k], kPair);
    }
    std::memcpy(upper + 2 * i, up, kPairs * kPair);
    std::memcpy(lower + 2 * i, low, kPairs * kPair);
  }
  for (; i < count; ++i) {
    std::memcpy(upper + 2 * i, pixels + offset[i], kPair);
    std::memcpy(lower + 2 * i, below + offset[i], kPair);
  }
}

LAPAROSCOPE_SERVO_CLONES
void blend(const float* __restrict upper, const float* __restrict lower, const float* __restrict right_of,
           const float* __restrict below, int count, float* __restrict patch) {
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const float top = upper[2 * i] + right_of[i] * (upper[2 * i + 1] - upper[2 * i]);
    const float low = lower[2 * i] + right_of[i] * (lower[2 * i + 1] - lower[2 * i]);
    patch[i] = top + below[i] * (low - top);
  }
}

// Returns how many pixels are valid. `lens`: null without one.
int warpRow(const cv::Mat1f& image, int width, const Row& row, const LensLoop* lens, int count, float* patch,
            float* valid) {
  const float* pixels = image.ptr<float>();
  const int stride = static_cast<int>(image.step1());
  const int step_down = image.rows > 1 ? stride : 0;
  int offset[kChunk];
  float right_of[kChunk], below[kChunk], upper[2 * kChunk], lower[2 * kChunk], u[kChunk], v[kChunk];
  int inside = 0;
  for (int first = 0; first < count; first += kChunk) {
    const int n = std::min(kChunk, count - first);
    if (lens == nullptr) {
      inside += locate(row, stride, width, image.rows, first, n, offset, right_of, below, valid + first);
    } else {
      locateRaw(*lens, row, first, n, u, v);
      inside += place(u, v, stride, width, image.rows, n, offset, right_of, below, valid + first);
    }
    gather(pixels, step_down, offset, n, upper, lower);
    blend(upper, lower, right_of, below, n, patch + first);
  }
  return inside;
}

Row rowOf(const Eigen::Matrix3d& g, int j) {
  const Eigen::Vector3d start = g.col(1) * j + g.col(2);
  return {static_cast<float>(start[0]), static_cast<float>(g(0, 0)),  static_cast<float>(start[1]),
          static_cast<float>(g(1, 0)),  static_cast<float>(start[2]), static_cast<float>(g(2, 0))};
}

template <typename PatchRow, typename ValidRow>
bool warpRows(const cv::Mat1f& image, const Eigen::Matrix3d& g, const LensLoop* lens, int width, int height,
              PatchRow patch, ValidRow valid) {
  // Pairs of neighbours are read, so an image of one column gets a second one.
  cv::Mat1f widened;
  if (image.cols == 1) cv::hconcat(image, image, widened);
  const cv::Mat1f& source = image.cols == 1 ? widened : image;
  int inside = 0;
  for (int j = 0; j < height; ++j) {
    inside += warpRow(source, image.cols, rowOf(g, j), lens, width, patch(j), valid(j));
  }
  return inside == width * height;
}

}  // namespace

bool warpBilinear(const cv::Mat1f& image, const Eigen::Matrix3d& g, Patch& patch, Patch& valid) {
  return warpRows(
      image, g, nullptr, patch.width(), patch.height(), [&](int j) { return patch.row(j); },
      [&](int j) { return valid.row(j); });
}

bool warpBilinear(const cv::Mat1f& image, const Eigen::Matrix3d& g, cv::Mat1f& patch, cv::Mat1f& valid) {
  return warpRows(
      image, g, nullptr, patch.cols, patch.rows, [&](int j) { return patch.ptr<float>(j); },
      [&](int j) { return valid.ptr<float>(j); });
}

bool warpBilinear(const cv::Mat1f& image, const Eigen::Matrix3d& g, const Lens& lens, const RawWindow& window,
                  Patch& patch, Patch& valid) {
  const LensLoop loop = lens.loop(window);
  return warpRows(
      image, lens.raysFromRectified() * g, &loop, patch.width(), patch.height(), [&](int j) { return patch.row(j); },
      [&](int j) { return valid.row(j); });
}

bool warpBilinear(const cv::Mat1f& image, const Eigen::Matrix3d& g, const Lens& lens, const RawWindow& window,
                  cv::Mat1f& patch, cv::Mat1f& valid) {
  const LensLoop loop = lens.loop(window);
  return warpRows(
      image, lens.raysFromRectified() * g, &loop, patch.cols, patch.rows, [&](int j) { return patch.ptr<float>(j); },
      [&](int j) { return valid.ptr<float>(j); });
}

cv::Mat1f rectify(const cv::Mat1f& image, const Eigen::Matrix3d& g, const Lens& lens, const RawWindow& window,
                  const cv::Size& size) {
  const LensLoop loop = lens.loop(window);
  const Eigen::Matrix3d rays = lens.raysFromRectified() * g;
  cv::Mat1f u(size), v(size), result;
  for (int j = 0; j < size.height; ++j)
    locateRaw(loop, rowOf(rays, j), 0, size.width, u.ptr<float>(j), v.ptr<float>(j));
  cv::patchNaNs(u, -1e4);
  cv::patchNaNs(v, -1e4);
  cv::remap(image, result, u, v, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  return result;
}

}  // namespace laparoscope_servo::image
