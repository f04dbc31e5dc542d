#include "tracking/esm/esm_kernels.h"

#include <algorithm>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kLanes = image::Patch::kStrip;

// One row of a cell, with the rows above and below for the gradient.
struct Rows {
  const float *image_above, *image, *image_below;
  const float *reference_above, *reference, *reference_below;
  const float* weight;
};

// The order of CellSums' members.
enum Sum { kXX, kXY, kYY, kXR, kYR, kX, kY, kXM, kYM, kW, kR, kM, kMM, kMR, kSums };

// The sums, lane by lane. The lanes are added when the cell is complete.
using Lanes = float[kSums][kLanes];

// The first `cells` lanes of each sum become those of the cells: halves of each cell's lanes are added until one is
// left.
inline void fold(int cells, Lanes& s) {
  for (int width = kLanes / cells; width > 1; width /= 2) {
    const int half = width / 2;
    for (int k = 0; k < kSums; ++k) {
      for (int cell = 0; cell < cells; ++cell) {
        for (int i = 0; i < half; ++i) s[k][cell * half + i] = s[k][cell * width + i] + s[k][cell * width + half + i];
      }
    }
  }
}

LAPAROSCOPE_SERVO_CLONES
void sumCell(const Rows* rows, int count, float gain, float bias, float inverse_rejection, int cells, CellSums* sums) {
  Lanes s = {};
  for (int j = 0; j < count; ++j) {
    const Rows& row = rows[j];
#pragma omp simd
    for (int i = 0; i < kLanes; ++i) {
      const float image = row.image[i];
      const float reference = row.reference[i];
      const float r = gain * image + bias - reference;
      const float e = r * inverse_rejection;
      const float t = 1.0f - e * e;
      const float tukey = t > 0.0f ? t : 0.0f;
      const float w = row.weight[i] * tukey * tukey;
      // The gradients of image and reference are added, which makes the step second-order.
      const float gx =
          0.5f * (gain * (row.image[i + 1] - row.image[i - 1]) + (row.reference[i + 1] - row.reference[i - 1]));
      const float gy =
          0.5f * (gain * (row.image_below[i] - row.image_above[i]) + (row.reference_below[i] - row.reference_above[i]));
      const float m = 0.5f * (image + reference);
      const float wx = w * gx;
      const float wy = w * gy;
      const float wm = w * m;
      s[kXX][i] += wx * gx;
      s[kXY][i] += wx * gy;
      s[kYY][i] += wy * gy;
      s[kXR][i] += wx * r;
      s[kYR][i] += wy * r;
      s[kX][i] += wx;
      s[kY][i] += wy;
      s[kXM][i] += wx * m;
      s[kYM][i] += wy * m;
      s[kW][i] += w;
      s[kR][i] += w * r;
      s[kM][i] += wm;
      s[kMM][i] += wm * m;
      s[kMR][i] += wm * r;
    }
    // Prefetches the next strip: the processor does not predict accesses down a column.
    __builtin_prefetch(row.image + 2 * kLanes);
    __builtin_prefetch(row.reference + 2 * kLanes);
    __builtin_prefetch(row.weight + 2 * kLanes);
  }
  if (cells == 1) {
    fold(1, s);
  } else if (cells == 2) {
    fold(2, s);
  } else {
    fold(4, s);
  }
  for (int c = 0; c < cells; ++c) {
    sums[c] = {s[kXX][c], s[kXY][c], s[kYY][c], s[kXR][c], s[kYR][c], s[kX][c],  s[kY][c],
               s[kXM][c], s[kYM][c], s[kW][c],  s[kR][c],  s[kM][c],  s[kMM][c], s[kMR][c]};
  }
}

}  // namespace

void sumCells(const CellInput& input, int first_row, int rows, int per_strip, const float* bias, CellSums* sums) {
  Rows cell[kMaxCellRows];
  const int strips = input.image->strips();
  for (int strip = 0; strip < strips; ++strip) {
    const int column = strip * kLanes;
    for (int j = 0; j < rows; ++j) {
      const int row = first_row + j;
      cell[j] = {input.image->row(row - 1) + column, input.image->row(row) + column,
                 input.image->row(row + 1) + column, input.reference->row(row - 1) + column,
                 input.reference->row(row) + column, input.reference->row(row + 1) + column,
                 input.weight->row(row) + column};
    }
    sumCell(cell, rows, input.gain, bias[strip], input.inverse_rejection, per_strip, sums + strip * per_strip);
  }
}

}  // namespace laparoscope_servo::tracking
