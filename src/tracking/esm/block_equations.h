// ESM's normal equations at one iteration, from the pixels of a level: summed cell by cell, block of light by block of
// light.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/tracking/tracker_config.h"
#include "tracking/esm/esm_level.h"
#include "tracking/esm/normal_equations.h"

namespace laparoscope_servo::tracking {

struct CellInput;

// What a block of a plane adds, see NormalEquations: its weight, weighted residual and Jacobian, and its part of J'Wr.
struct BlockSums {
  double weight;
  double residual;
  Vector10d jacobian;
  Vector10d score;
};

class BlockEquations {
 public:
  // Those of the level's image as it is warped now, with the biases that its planes have. `light`: what of the light is
  // unknown. `rejection` [grey levels]: residuals from which on Tukey's weights are 0; 0 gives every residual its full
  // weight.
  void sum(const EsmLevel& level, const geometry::Rectangle& roi, Light light, double gain, double rejection);

  Matrix10d matrix() const { return equations_.matrix(); }
  const Vector10d& vector() const { return equations_.vector(); }
  const std::vector<BlockSums>& blocks() const { return blocks_; }  // plane by plane, row by row

 private:
  void sumBlockRow(const EsmLevel& level, const Eigen::Matrix3d& unit_T_patch, const CellInput& input,
                   const EsmPlane& plane, int block_row);

  NormalEquations equations_;
  std::vector<BlockSums> blocks_;
  std::vector<float> strip_bias_;
  std::vector<CellSums> cells_;  // of a block row: cell rows times strips
};

}  // namespace laparoscope_servo::tracking
