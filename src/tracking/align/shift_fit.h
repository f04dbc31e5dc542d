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
  Matrix8d covariance = Matrix8d::Zero();             // of x, from the scatter of the blocks about the fit
  double significance = 0.0;                          // squared Mahalanobis distance of x from 0, per degree of freedom
};

// Robust fit to the confident shifts; empty if there are fewer than five. A prior keeps turn, shear and perspective
// small unless the shifts determine them. `side`: of a block [px of the reference].
std::optional<ShiftFit> fitShifts(const std::vector<BlockShift>& shifts, const geometry::Rectangle& roi, double side);

// Fewer confident shifts, beside an instrument, tell nothing of the rest of the region.
constexpr int kDeformationShifts = 8;

// Covariance of x that comes of tissue which is not a plane, or deforms: from the confident shifts' `median` [px], as
// far as it exceeds the accuracy of block matching, and for what the fit to these shifts has taken up of it. Zero if it
// does not, or if fewer than kDeformationShifts are confident.
Matrix8d deformationCovariance(const std::vector<BlockShift>& shifts, double median, const geometry::Rectangle& roi);

// Tissue deforms where it is covered, too: as long as too few shifts tell by how much, it counts as deformed as it was.
class DeformationMemory {
 public:
  // `covariance`: by deformationCovariance, of so many confident shifts. With fewer than kDeformationShifts it is
  // replaced by that of the last image that had as many; zero before there was one.
  void complete(int confident, Matrix8d& covariance);

 private:
  Matrix8d last_ = Matrix8d::Zero();
};

// Median length of the confident shifts [px of the current image]; NaN if there is none.
double medianShift(const std::vector<BlockShift>& shifts, const Eigen::Matrix3d& g);
int confidentShifts(const std::vector<BlockShift>& shifts);

// How far the confident shifts are spread over the region, in the direction in which they are spread least: their
// standard deviation over that of blocks all over the region. 0 (one place, or one line) to about 1; 0 without any.
double spreadOfShifts(const std::vector<BlockShift>& shifts, const geometry::Rectangle& roi, double side);

}  // namespace laparoscope_servo::tracking
