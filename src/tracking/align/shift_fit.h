// Fits a correction of the homography to the shifts that block matching has measured.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/geometry/sl3.h"
#include "tracking/align/block_matching.h"
#include "tracking/esm/normal_equations.h"

namespace laparoscope_servo::tracking {

struct ShiftFit {
  geometry::Vector8d x = geometry::Vector8d::Zero();  // G -> G N^-1 exp(A(x)) N, see MotionPrior
  Matrix8d covariance = Matrix8d::Zero();             // of x, by how the blocks scatter about it
  double significance = 0.0;  // of x against 0: squared standard deviations, a degree of freedom
};

// Of the confident shifts, robustly; empty when there are fewer than five. As many degrees of freedom as they
// determine: turn, shear and perspective only as far as they are seen. `side`: px of the reference, of a block.
std::optional<ShiftFit> fitShifts(const std::vector<BlockShift>& shifts, const geometry::Rectangle& roi, double side);

// Covariance of x, as above, that comes of tissue which is no plane, or deforms: of the confident shifts' `median`
// [px], what is more than measuring a block errs by. Zero where the shifts are as small, or fewer than eight.
Matrix8d deformationCovariance(const std::vector<BlockShift>& shifts, double median, const geometry::Rectangle& roi);

// px of the image that `g` leads to, the median of the confident shifts; NaN when there is none.
double medianShift(const std::vector<BlockShift>& shifts, const Eigen::Matrix3d& g);
int confidentShifts(const std::vector<BlockShift>& shifts);

}  // namespace laparoscope_servo::tracking
