// The covariance of an estimate of ESM, from its residuals and its prior.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"
#include "tracking/esm/normal_equations.h"

namespace laparoscope_servo::tracking {

struct EstimateCovariance {
  std::optional<Matrix8d> covariance;  // of x, as in MotionPrior; empty when nothing determines it
  double noise = 0.0;                  // see EsmResult
};

// `matrix` and `blocks`: the equations at the estimate. `sigma`: standard deviation of the residuals [grey levels].
// `prior`: inverse covariance of x before the image was used; zero for none.
EstimateCovariance estimateCovariance(const Matrix10d& matrix, const std::vector<LightBlockSums>& blocks, double sigma,
                                      const Matrix8d& prior);

// The covariance for independent residuals of this variance [grey levels squared], without a prior.
std::optional<Matrix8d> covarianceOfNoise(const Matrix10d& matrix, double variance);

// px in the image, standard deviation of the ROI's worst corner at `g`, for this covariance of x.
double cornerError(const Eigen::Matrix3d& g, const geometry::Rectangle& roi, const Matrix8d& covariance);
// px in the image, standard deviation of the ROI's centre at `g`, for this covariance of x.
double centreError(const Eigen::Matrix3d& g, const geometry::Rectangle& roi, const Matrix8d& covariance);

}  // namespace laparoscope_servo::tracking
