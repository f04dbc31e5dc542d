#include "laparoscope_servo/image/colour_patch.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>

#include "image/kernel_parts.h"
#include "laparoscope_servo/image/image_type.h"
#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::image {

namespace {

constexpr int kChunk = 256;  // pixels of a row that are processed at once
constexpr int kMaxGrow = kChunk / 4;

using Row = ProjectiveRow;

struct ByteFrame {
  float right, bottom;  // px, beyond the last pixel
  int stride, channels;
};

// Offset of a pixel's first byte in the image; that of the first pixel where it lies outside, with valid 0.
struct Pixel {
  int offset;
  unsigned char valid;
};

// (u, v): from the first pixel's upper left corner, so that the conversion to int, towards zero, finds the nearest
// centre.
[[gnu::always_inline]] inline Pixel pixelAt(const ByteFrame& frame, float u, float v, bool seen) {
  const int inside = static_cast<int>(u > 0.0f) & static_cast<int>(u < frame.right) & static_cast<int>(v > 0.0f) &
                     static_cast<int>(v < frame.bottom) & static_cast<int>(seen);
  const int column = static_cast<int>(inside != 0 ? u : 0.0f);
  const int line = static_cast<int>(inside != 0 ? v : 0.0f);
  return {line * frame.stride + column * frame.channels, static_cast<unsigned char>(-inside)};
}

LAPAROSCOPE_SERVO_CLONES
void locate(const Row& row, ByteFrame frame, int first, int count, int* __restrict offset,
            unsigned char* __restrict valid) {
  const Row r = row;
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const auto [x, y, w] = pointOf(r, static_cast<float>(first + i));
    const Pixel pixel = pixelAt(frame, x + 0.5f, y + 0.5f, w > 0.0f);
    offset[i] = pixel.offset;
    valid[i] = pixel.valid;
  }
}

// pixelAt() for points computed by locateRaw.
LAPAROSCOPE_SERVO_CLONES
void place(const float* __restrict u, const float* __restrict v, ByteFrame frame, int count, int* __restrict offset,
           unsigned char* __restrict valid) {
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const Pixel pixel = pixelAt(frame, u[i] + 0.5f, v[i] + 0.5f, true);
    offset[i] = pixel.offset;
    valid[i] = pixel.valid;
  }
}

// Splits pixels of four bytes, the last of which is not used.
LAPAROSCOPE_SERVO_CLONES
void split(const unsigned char* __restrict pixels, const unsigned char* __restrict valid, int count,
           unsigned char* __restrict blue, unsigned char* __restrict green, unsigned char* __restrict red) {
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    blue[i] = pixels[4 * i] & valid[i];
    green[i] = pixels[4 * i + 1] & valid[i];
    red[i] = pixels[4 * i + 2] & valid[i];
  }
}

LAPAROSCOPE_SERVO_CLONES
int markBright(const unsigned char* __restrict b, const unsigned char* __restrict g, const unsigned char* __restrict r,
               int count, const std::array<int, 3>& thresholds, unsigned char* __restrict mask) {
  const int blue = thresholds[0], green = thresholds[1], red = thresholds[2];
  int any = 0;
#pragma omp simd reduction(| : any)
  for (int i = 0; i < count; ++i) {
    const int bright = static_cast<int>(b[i] >= blue) | static_cast<int>(g[i] >= green) | static_cast<int>(r[i] >= red);
    mask[i] = static_cast<unsigned char>(-bright);
    any |= bright;
  }
  return any;
}

LAPAROSCOPE_SERVO_CLONES
void add(const unsigned char* __restrict from, int count, unsigned char* __restrict to) {
#pragma omp simd
  for (int i = 0; i < count; ++i) to[i] = static_cast<unsigned char>(to[i] | from[i]);
}

// Marks bright pixels and dilates them along the row. Returns false if there are none.
bool markBrightRow(const unsigned char* b, const unsigned char* g, const unsigned char* r, int width,
                   const std::array<int, 3>& thresholds, int grow, unsigned char* mask) {
  unsigned char bright[kChunk];
  bool any = false;
  const int inner = kChunk - 2 * grow;
  std::fill_n(mask, width, static_cast<unsigned char>(0));
  for (int first = 0; first < width; first += inner) {
    const int count = std::min(inner, width - first);
    const int begin = std::max(first - grow, 0);
    const int end = std::min(first + count + grow, width);
    if (markBright(b + begin, g + begin, r + begin, end - begin, thresholds, bright) == 0) continue;
    any = true;
    for (int shift = -grow; shift <= grow; ++shift) {
      const int low = std::max(first, begin - shift);
      const int high = std::min(first + count, end - shift);
      if (low < high) add(bright + (low + shift - begin), high - low, mask + low);
    }
  }
  return any;
}

// Dilates across rows, in place: first from the rows below, which are unchanged yet, then from the rows above.
void growAcross(int grow, cv::Mat1b& mask) {
  for (int j = 0; j < mask.rows; ++j) {
    for (int k = 1; k <= std::min(grow, mask.rows - 1 - j); ++k) {
      add(mask.ptr<unsigned char>(j + k), mask.cols, mask.ptr<unsigned char>(j));
    }
  }
  for (int j = mask.rows - 1; j > 0; --j) {
    for (int k = 1; k <= std::min(grow, j); ++k) {
      add(mask.ptr<unsigned char>(j - k), mask.cols, mask.ptr<unsigned char>(j));
    }
  }
}

// `lens`: null without one.
void warpRows(const cv::Mat& image, const Eigen::Matrix3d& g, const LensLoop* lens, const cv::Size& size,
              ColourPatch& patch) {
  checkType(image);
  patch.has_colour = image.channels() == 3;
  patch.blue.create(size);
  patch.valid.create(size);
  if (patch.has_colour) {
    patch.green.create(size);
    patch.red.create(size);
  }
  const ByteFrame frame = {static_cast<float>(image.cols), static_cast<float>(image.rows),
                           static_cast<int>(image.step[0]), image.channels()};
  // Pixels are read with the byte behind them, which the image's last one does not have.
  const int last = static_cast<int>(image.step[0]) * (image.rows - 1) + 3 * (image.cols - 1);
  int offset[kChunk];
  float u[kChunk], v[kChunk];
  unsigned char pixels[4 * kChunk] = {};
  for (int j = 0; j < size.height; ++j) {
    const Eigen::Vector3f start = (g.col(1) * j + g.col(2)).cast<float>();
    const Eigen::Vector3f step = g.col(0).cast<float>();
    const Row row = {start[0], step[0], start[1], step[1], start[2], step[2]};
    for (int first = 0; first < size.width; first += kChunk) {
      const int count = std::min(kChunk, size.width - first);
      unsigned char* valid = patch.valid.ptr<unsigned char>(j) + first;
      if (lens == nullptr) {
        locate(row, frame, first, count, offset, valid);
      } else {
        locateRaw(*lens, row, first, count, u, v);
        place(u, v, frame, count, offset, valid);
      }
      unsigned char* blue = patch.blue.ptr<unsigned char>(j) + first;
      if (!patch.has_colour) {
        for (int i = 0; i < count; ++i) blue[i] = image.data[offset[i]] & valid[i];
        continue;
      }
      for (int i = 0; i < count; ++i) {
        if (offset[i] < last) {
          std::memcpy(pixels + 4 * i, image.data + offset[i], 4);
        } else {
          std::memcpy(pixels + 4 * i, image.data + offset[i], 3);
        }
      }
      split(pixels, valid, count, blue, patch.green.ptr<unsigned char>(j) + first,
            patch.red.ptr<unsigned char>(j) + first);
    }
  }
}

}  // namespace

void warpNearest(const cv::Mat& image, const Eigen::Matrix3d& g, const cv::Size& size, ColourPatch& patch) {
  warpRows(image, g, nullptr, size, patch);
}

void warpNearest(const cv::Mat& image, const Eigen::Matrix3d& g, const Lens* lens, const cv::Size& size,
                 ColourPatch& patch) {
  if (lens == nullptr) return warpNearest(image, g, size, patch);
  const LensLoop loop = lens->loop({});
  warpRows(image, lens->raysFromRectified() * g, &loop, size, patch);
}

void saturatedPixels(const ColourPatch& patch, const std::array<int, 3>& thresholds, int grow, cv::Mat1b& mask) {
  if (grow < 0 || grow > kMaxGrow) {
    throw std::invalid_argument("growth of " + std::to_string(grow) + " px, expected 0 to " + std::to_string(kMaxGrow));
  }
  mask.create(patch.size());
  bool any = false;
  for (int j = 0; j < mask.rows; ++j) {
    const unsigned char* blue = patch.blue.ptr<unsigned char>(j);
    const unsigned char* green = patch.has_colour ? patch.green.ptr<unsigned char>(j) : blue;
    const unsigned char* red = patch.has_colour ? patch.red.ptr<unsigned char>(j) : blue;
    any |= markBrightRow(blue, green, red, mask.cols, thresholds, grow, mask.ptr<unsigned char>(j));
  }
  if (any) growAcross(grow, mask);
}

}  // namespace laparoscope_servo::image
