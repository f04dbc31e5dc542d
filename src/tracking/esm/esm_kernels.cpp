#include "tracking/esm/esm_kernels.h"

#include <algorithm>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kLanes = image::Patch::kStrip;

// The first pixel of a row of cells in each patch, and how far apart the patches' rows are.
struct Corner {
  const float *image, *reference, *weight;
  int stride;
};

// The order of CellSums' members.
enum Sum { kXX, kXY, kYY, kXR, kYR, kX, kY, kXM, kYM, kW, kR, kM, kMM, kMR, kSums };

// The sums, lane by lane. The lanes are added when the cell is complete.
using Lanes = float[kSums][kLanes];

// Adds up each cell's lanes: its halves, then the halves of what comes out, until one lane is left.
template <int kCells>
[[gnu::always_inline]] inline void fold(const Lanes& s, CellSums* sums) {
  constexpr int kFour = kLanes / 4;  // lanes are left of each sum
  for (int cell = 0; cell < kCells; ++cell) {
    float four[kSums][kFour];
    for (int k = 0; k < kSums; ++k) {
      const float* const lanes = s[k] + cell * (kLanes / kCells);
#pragma omp simd
      for (int i = 0; i < kFour; ++i) {
        if (kCells == 1) {
          four[k][i] = (lanes[i] + lanes[i + 8]) + (lanes[i + 4] + lanes[i + 12]);
        } else {
          four[k][i] = kCells == 2 ? lanes[i] + lanes[i + 4] : lanes[i];
        }
      }
    }
    float* const to = reinterpret_cast<float*>(sums + cell);  // the members, in the order of Sum
#pragma omp simd
    for (int k = 0; k < kSums; ++k) to[k] = (four[k][0] + four[k][2]) + (four[k][1] + four[k][3]);
  }
}

// The sums over a strip of a row of cells, of one row at least: the lanes then stay in registers.
[[gnu::always_inline]] inline void sumStrip(const Corner& corner, int column, int rows, float gain, float bias,
                                            float inverse_rejection, Lanes& s) {
  const int stride = corner.stride;
#pragma GCC unroll 16
  for (int k = 0; k < kSums; ++k) {
#pragma omp simd
    for (int i = 0; i < kLanes; ++i) s[k][i] = 0.0f;
  }
  int j = 0;
  do {
    const float* const image_row = corner.image + column + j * stride;
    const float* const reference_row = corner.reference + column + j * stride;
    const float* const weight_row = corner.weight + column + j * stride;
#pragma omp simd
    for (int i = 0; i < kLanes; ++i) {
      const float image = image_row[i];
      const float reference = reference_row[i];
      const float r = gain * image + bias - reference;
      const float e = r * inverse_rejection;
      const float t = 1.0f - e * e;
      const float tukey = t > 0.0f ? t : 0.0f;
      const float w = weight_row[i] * tukey * tukey;
      // The gradients of image and reference are added, which makes the step second-order.
      const float gx =
          0.5f * (gain * (image_row[i + 1] - image_row[i - 1]) + (reference_row[i + 1] - reference_row[i - 1]));
      const float gy = 0.5f * (gain * (image_row[i + stride] - image_row[i - stride]) +
                               (reference_row[i + stride] - reference_row[i - stride]));
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
    __builtin_prefetch(image_row + 2 * kLanes);
    __builtin_prefetch(reference_row + 2 * kLanes);
    __builtin_prefetch(weight_row + 2 * kLanes);
  } while (++j < rows);
}

LAPAROSCOPE_SERVO_CLONES
void sumRow(const Corner& corner, int rows, int strips, float gain, const float* bias, float inverse_rejection,
            int per_strip, CellSums* sums) {
  for (int strip = 0; strip < strips; ++strip, sums += per_strip) {
    Lanes s;
    sumStrip(corner, strip * kLanes, rows, gain, bias[strip], inverse_rejection, s);
    if (per_strip == 1) {
      fold<1>(s, sums);
    } else if (per_strip == 2) {
      fold<2>(s, sums);
    } else {
      fold<4>(s, sums);
    }
  }
}

// Adds the moments of a column of cells. Along it only v changes: the sums are added up times powers of v first.
LAPAROSCOPE_SERVO_CLONES
void addColumn(const float* __restrict cells, int stride, int count, double u, const double* __restrict v,
               double (*__restrict low)[CellMoments::kSums], double (*__restrict high)[CellMoments::kSecond]) {
  constexpr int kAll = CellMoments::kSums, kSecond = CellMoments::kSecond;
  double s0[kAll] = {}, s1[kAll] = {}, s2[kAll] = {}, s3[kSecond] = {}, s4[kSecond] = {};
  for (int k = 0; k < count; ++k) {
    const float* const sums = cells + k * stride;
    const double v1 = v[k], v2 = v1 * v1, v3 = v2 * v1, v4 = v2 * v2;
#pragma omp simd
    for (int i = 0; i < kAll; ++i) {
      const double sum = static_cast<double>(sums[i]);
      s0[i] += sum;
      s1[i] += v1 * sum;
      s2[i] += v2 * sum;
    }
#pragma omp simd
    for (int i = 0; i < kSecond; ++i) {
      const double sum = static_cast<double>(sums[i]);
      s3[i] += v3 * sum;
      s4[i] += v4 * sum;
    }
  }
  const double u2 = u * u, u3 = u2 * u, u4 = u2 * u2;
#pragma omp simd
  for (int i = 0; i < kAll; ++i) {
    low[0][i] += s0[i];
    low[1][i] += s1[i];
    low[2][i] += u * s0[i];
    low[3][i] += s2[i];
    low[4][i] += u * s1[i];
    low[5][i] += u2 * s0[i];
  }
#pragma omp simd
  for (int i = 0; i < kSecond; ++i) {
    high[0][i] += s3[i];
    high[1][i] += u * s2[i];
    high[2][i] += u2 * s1[i];
    high[3][i] += u3 * s0[i];
    high[4][i] += s4[i];
    high[5][i] += u * s3[i];
    high[6][i] += u2 * s2[i];
    high[7][i] += u3 * s1[i];
    high[8][i] += u4 * s0[i];
  }
}

}  // namespace

void addMoments(const CellSums* cells, int stride, int count, double u, const double* v, CellMoments& moments) {
  addColumn(reinterpret_cast<const float*>(cells), stride * CellMoments::kSums, count, u, v, moments.low, moments.high);
}

void sumCells(const CellInput& input, int first_row, int rows, int per_strip, const float* bias, CellSums* sums) {
  const Corner corner = {input.image->row(first_row), input.reference->row(first_row), input.weight->row(first_row),
                         input.image->stride()};
  sumRow(corner, rows, input.image->strips(), input.gain, bias, input.inverse_rejection, per_strip, sums);
}

}  // namespace laparoscope_servo::tracking
