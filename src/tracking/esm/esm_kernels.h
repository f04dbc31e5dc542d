// The inner loops of ESM. Private to the tracking part.
#pragma once

#include "laparoscope_servo/image/patch.h"
#include "tracking/esm/normal_equations.h"

namespace laparoscope_servo::tracking {

// Cells have at most this many rows; they are as wide as a strip, or a half or a quarter of it.
constexpr int kMaxCellRows = 16;

// The margins of image and reference must be extrapolated.
struct CellInput {
  const image::Patch* image = nullptr;  // warped
  const image::Patch* reference = nullptr;
  const image::Patch* weight = nullptr;
  float gain = 1.0f;
  float inverse_rejection = 0.0f;  // 1 / (C sigma) of Tukey's weights; 0 gives all residuals full weight
};

// Sums over the cells of rows first_row .. first_row + rows - 1 (at most kMaxCellRows), `per_strip` (1, 2 or 4) cells
// for each strip, from left to right. `bias`: one for each strip. The gradients in the sums are those of gain * image
// plus those of the reference, per pixel: twice their mean.
void sumCells(const CellInput& input, int first_row, int rows, int per_strip, const float* bias, CellSums* sums);

}  // namespace laparoscope_servo::tracking
