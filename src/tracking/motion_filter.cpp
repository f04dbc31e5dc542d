#include "tracking/motion_filter.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>

namespace laparoscope_servo::tracking {

namespace {

constexpr double kLearningTime = 0.8;  // s, time constant of the innovation and noise estimates
constexpr int kImagesOfDoubt = 5;      // images that the initial innovation covariance is worth
constexpr double kLongestGap = 0.4;    // s without an image, for which the innovation still grows

// lengthUnit()s, standard deviations by which shift, affine motion and perspective move the ROI's border against the
// prediction: the initial values, and the least values, which a target that stood still may reach in the next image.
struct Spread {
  double shift, affine, perspective;
};
constexpr Spread kGuess = {4.0, 2.0, 1.0};
constexpr Spread kLeast = {0.5, 0.2, 0.1};

constexpr double kGuessedNoise = 400.0;  // grey levels squared

Matrix8d covariance(const Spread& px, double half_size) {
  geometry::Vector8d sigma;
  sigma << px.shift, px.shift, px.affine, px.affine, px.affine, px.affine, px.perspective, px.perspective;
  return (sigma / half_size).cwiseAbs2().asDiagonal();
}

}  // namespace

void MotionFilter::start(const geometry::Rectangle& roi, const Eigen::Matrix3d& normalisation, double stamp) {
  const double half_size = 1.0 / normalisation(0, 0);
  *this = MotionFilter(damping_);
  roi_ = roi;
  steps_ = geometry::Sl3Steps(normalisation);
  last_stamp_ = stamp;
  innovation_ = covariance(kGuess, half_size / lengthUnit(roi));
  least_ = covariance(kLeast, half_size / lengthUnit(roi));
  noise_ = kGuessedNoise;
}

geometry::Vector8d MotionFilter::deviation(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) const {
  return steps_.minus(to, from);
}

MotionPrior MotionFilter::predict(double stamp, const std::optional<Eigen::Matrix3d>& carried) const {
  MotionPrior prior;
  const double dt = std::max(0.0, stamp - last_stamp_);
  const Eigen::Matrix3d from = carried.value_or(last_);
  prior.predicted = steps_.plus(from, damping_ * dt * (carried ? rest_ : velocity_));
  if (!geometry::isConvex(geometry::apply(prior.predicted, roi_.corners()))) prior.predicted = from;
  const double images = interval_ > 0.0 ? std::max(1.0, std::min(dt, kLongestGap) / interval_) : 1.0;
  const Matrix8d expected = covariance_ + images * images * (innovation_ + least_);
  prior.information = expected.ldlt().solve(Matrix8d::Identity());
  prior.noise = noise_;
  return prior;
}

void MotionFilter::update(const MotionPrior& prior, const EsmResult& estimate, double stamp, bool learn,
                          const std::optional<Eigen::Matrix3d>& carried) {
  const double dt = stamp - last_stamp_;
  const geometry::Vector8d x = deviation(prior.predicted, estimate.state.g);
  if (learn && x.allFinite()) {
    ++learned_;
    const double rate = std::clamp(dt / kLearningTime, 1.0 / (kImagesOfDoubt + learned_), 1.0);
    innovation_ += rate * (x * x.transpose() - innovation_);
    noise_ += rate * (estimate.noise - noise_);
    if (dt > 0.0) interval_ = interval_ > 0.0 ? interval_ + rate * (dt - interval_) : dt;
  }
  const geometry::Vector8d motion = deviation(last_, estimate.state.g);
  restart(estimate, stamp);
  if (dt > 0.0 && motion.allFinite()) velocity_ = motion / dt;
  if (!carried) return;
  const geometry::Vector8d rest = deviation(*carried, estimate.state.g);
  if (dt > 0.0 && rest.allFinite()) rest_ = rest / dt;
}

void MotionFilter::restart(const EsmResult& estimate, double stamp) {
  last_ = estimate.state.g;
  last_stamp_ = stamp;
  covariance_ = estimate.covariance;
  stop();
}

}  // namespace laparoscope_servo::tracking
