#include "tracking/esm/block_equations.h"

#include <algorithm>

#include "tracking/esm/esm_kernels.h"

namespace laparoscope_servo::tracking {

void BlockEquations::sum(const EsmLevel& level, const geometry::Rectangle& roi, Light light, double gain,
                         double rejection) {
  CellInput input;
  input.weight = &level.usedWeight();
  input.gain = static_cast<float>(gain);
  input.inverse_rejection = rejection > 0.0 ? static_cast<float>(1.0 / rejection) : 0.0f;
  // The kernel adds both gradients; J takes their mean, per normalised unit.
  const Eigen::Matrix3d unit_T_patch = templateFromPixels(roi) * level.image_T_patch;
  equations_.reset(light, 0.5 * halfSize(roi) / level.scale);
  blocks_.clear();
  for (const EsmPlane& plane : level.planes) {
    input.image = &plane.warped;
    input.reference = &plane.value;
    for (int row = 0; row + 1 < static_cast<int>(level.block_row_begin.size()); ++row) {
      sumBlockRow(level, unit_T_patch, input, plane, row);
    }
  }
}

void BlockEquations::sumBlockRow(const EsmLevel& level, const Eigen::Matrix3d& unit_T_patch, const CellInput& input,
                                 const EsmPlane& plane, int block_row) {
  const int begin = level.block_row_begin[block_row];
  const int end = level.block_row_begin[block_row + 1];
  const int cell_rows = (end - begin + level.cell_rows - 1) / level.cell_rows;
  const int strips = level.weight.strips();
  strip_bias_.resize(strips);
  for (int strip = 0; strip < strips; ++strip) {
    const std::size_t block = block_row * level.block_columns + level.block_of_strip[strip];
    strip_bias_[strip] = static_cast<float>(plane.biasOf(block, input.gain));
  }
  const int per_strip = level.cells_per_strip;
  cells_.resize(static_cast<std::size_t>(cell_rows) * strips * per_strip);
  for (int k = 0; k < cell_rows; ++k) {
    const int row = begin + k * level.cell_rows;
    sumCells(input, row, std::min(level.cell_rows, end - row), per_strip, strip_bias_.data(),
             cells_.data() + k * strips * per_strip);
  }
  const int cell_columns = image::Patch::kStrip / per_strip;
  for (int strip = 0; strip < strips; ++strip) {
    for (int cell = strip * per_strip; cell < (strip + 1) * per_strip; ++cell) {
      const int columns = std::min(cell_columns, level.width - cell * cell_columns);
      if (columns <= 0) break;
      const double u = unit_T_patch(0, 2) + unit_T_patch(0, 0) * (cell * cell_columns + 0.5 * (columns - 1));
      for (int k = 0; k < cell_rows; ++k) {
        const int row = begin + k * level.cell_rows;
        const int rows = std::min(level.cell_rows, end - row);
        const double v = unit_T_patch(1, 2) + unit_T_patch(1, 1) * (row + 0.5 * (rows - 1));
        equations_.addCell(cells_[k * strips * per_strip + cell], u, v);
      }
    }
    if (strip + 1 < strips && level.block_of_strip[strip + 1] == level.block_of_strip[strip]) continue;
    equations_.endBlock();
    blocks_.push_back(
        {equations_.blockWeight(), equations_.blockResidual(), equations_.blockJacobian(), equations_.blockScore()});
  }
}

}  // namespace laparoscope_servo::tracking
