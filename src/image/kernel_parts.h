// Functions shared by the kernels and inlined into each of their versions: see multiversion.h. Private to the image
// part.
#pragma once

#include <algorithm>

#include "laparoscope_servo/image/lens.h"

namespace laparoscope_servo::image {

struct RowPoint {
  float x, y;
  float w;  // the map's denominator: the point is visible if it is positive
};

// The point to which the map takes the row's pixel `t`.
[[gnu::always_inline]] inline RowPoint pointOf(const ProjectiveRow& row, float t) {
  const float w = row.w0 + row.w1 * t;
  const float per_w = 1.0f / w;
  return {(row.u0 + row.u1 * t) * per_w, (row.v0 + row.v1 * t) * per_w, w};
}

// An image whose pixels are `stride` apart from row to row.
struct PixelFrame {
  PixelFrame(int width, int height, int pixel_stride)
      : right(static_cast<float>(width - 1)),
        bottom(static_cast<float>(height - 1)),
        last_column(static_cast<float>(std::max(width - 2, 0))),
        last_row(static_cast<float>(std::max(height - 2, 0))),
        stride(pixel_stride) {}
  float right, bottom;
  // The last column and row are reached from their neighbours; an image of one pixel has none.
  float last_column, last_row;
  int stride;
};

// The upper left of a point's four neighbours, and the point's place between them.
struct Neighbours {
  int offset;
  float right_of, below;
  int inside;  // 1 where the point lies in the image, else 0
};

[[gnu::always_inline]] inline Neighbours neighboursOf(const PixelFrame& frame, float u, float v) {
  // NaN and infinity become 0, which differs from the input, so the point counts as outside.
  float uc = u > 0.0f ? u : 0.0f;
  float vc = v > 0.0f ? v : 0.0f;
  uc = uc < frame.right ? uc : frame.right;
  vc = vc < frame.bottom ? vc : frame.bottom;
  const float column = uc < frame.last_column ? uc : frame.last_column;
  const float line = vc < frame.last_row ? vc : frame.last_row;
  const int iu = static_cast<int>(column);
  const int iv = static_cast<int>(line);
  return {iv * frame.stride + iu, uc - static_cast<float>(iu), vc - static_cast<float>(iv),
          static_cast<int>(uc == u) & static_cast<int>(vc == v)};
}

}  // namespace laparoscope_servo::image
