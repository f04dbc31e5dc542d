#include "esm_kernels.h"

#include <algorithm>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kLanes = image::Patch::kStrip;

struct Rows {
  const float* above;
  const float* image;
  const float* below;
  const float* reference;
  const float* reference_gx;
  const float* reference_gy;
  const float* weight;
};

// Adds one row of a cell, lane by lane. The lanes are summed when the cell is complete.
struct Lanes {
  float xx[kLanes], xy[kLanes], yy[kLanes], xr[kLanes], yr[kLanes], x[kLanes], y[kLanes], xm[kLanes], ym[kLanes], w[kLanes],
      r[kLanes], m[kLanes], mm[kLanes], mr[kLanes];
};

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
      // Image and reference alike, which makes the step second-order.
      const float gx = 0.5f * gain * (row.image[i + 1] - row.image[i - 1]) + row.reference_gx[i];
      const float gy = 0.5f * gain * (row.below[i] - row.above[i]) + row.reference_gy[i];
      const float m = 0.5f * (image + reference);
      const float wx = w * gx;
      const float wy = w * gy;
      const float wm = w * m;
      s.xx[i] += wx * gx;
      s.xy[i] += wx * gy;
      s.yy[i] += wy * gy;
      s.xr[i] += wx * r;
      s.yr[i] += wy * r;
      s.x[i] += wx;
      s.y[i] += wy;
      s.xm[i] += wx * m;
      s.ym[i] += wy * m;
      s.w[i] += w;
      s.r[i] += w * r;
      s.m[i] += wm;
      s.mm[i] += wm * m;
      s.mr[i] += wm * r;
    }
  }
  const int width = kLanes / cells;
  for (int cell = 0; cell < cells; ++cell) {
    CellSums c = {};
    for (int i = cell * width; i < (cell + 1) * width; ++i) {
      c.xx += s.xx[i];
      c.xy += s.xy[i];
      c.yy += s.yy[i];
      c.xr += s.xr[i];
      c.yr += s.yr[i];
      c.x += s.x[i];
      c.y += s.y[i];
      c.xm += s.xm[i];
      c.ym += s.ym[i];
      c.w += s.w[i];
      c.r += s.r[i];
      c.m += s.m[i];
      c.mm += s.mm[i];
      c.mr += s.mr[i];
    }
    sums[cell] = c;
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
      cell[j] = {input.image->row(row - 1) + column,       input.image->row(row) + column,
                 input.image->row(row + 1) + column,       input.reference->row(row) + column,
                 input.reference_gx->row(row) + column,    input.reference_gy->row(row) + column,
                 input.weight->row(row) + column};
    }
    sumCell(cell, rows, input.gain, bias[strip], input.inverse_rejection, per_strip, sums + strip * per_strip);
  }
}

}  // namespace laparoscope_servo::tracking
