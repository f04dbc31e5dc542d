#include "laparoscope_servo/servo/insertion_point_estimator.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "laparoscope_servo/robust/median.h"
#include "laparoscope_servo/robust/scale.h"
#include "laparoscope_servo/robust/weights.h"
#include "laparoscope_servo/validation/error_report.h"

namespace laparoscope_servo::servo {

namespace {

void throwUnlessValid(const InsertionPointConfig& config, const std::optional<InsertionPointPrior>& prior) {
  std::vector<std::string> errors = validate(config);
  if (prior && !(prior->point.allFinite() && prior->stddev > 0.0 && std::isfinite(prior->stddev))) {
    errors.push_back("prior: expected a finite point and a positive finite stddev");
  }
  validation::throwErrors("insertion point", errors);
}

double distanceFromLine(const Eigen::Vector3d& point, const Shaft& line) {
  return line.direction.cross(point - line.point).norm();
}

using Eigen3d = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;  // eigenvalues ascending

}  // namespace

InsertionPointEstimator::InsertionPointEstimator(const InsertionPointConfig& config,
                                                 const std::optional<InsertionPointPrior>& prior)
    : config_(config), prior_(prior) {
  throwUnlessValid(config, prior);
  samples_.reserve(static_cast<std::size_t>(config_.max_samples));
  recent_.reserve(static_cast<std::size_t>(config_.residual_samples));
  scratch_.reserve(static_cast<std::size_t>(std::max(config_.max_samples, config_.residual_samples)));
  reset();
}

void InsertionPointEstimator::reset() {
  samples_.clear();
  recent_.clear();
  next_recent_ = 0;
  residual_ = 0.0;
  level_ = ResidualLevel::kOk;
  estimate_ = InsertionPointEstimate();
  if (!prior_) return;
  estimate_.valid = true;
  estimate_.point = prior_->point;
  estimate_.covariance = prior_->stddev * prior_->stddev * Eigen::Matrix3d::Identity();
}

bool InsertionPointEstimator::update(double time, const Shaft& shaft) {
  if (!std::isfinite(time) || !shaft.point.allFinite()) return false;
  if (!(std::abs(shaft.direction.norm() - 1.0) < 0.01)) return false;
  if (!samples_.empty() && time < time_) reset();
  time_ = time;
  Sample sample;
  sample.time = time;
  sample.shaft = {shaft.point, shaft.direction.normalized()};
  insert(sample);
  const bool first = !estimate_.valid;
  // The first solution starts from equal weights and needs more rounds to reject the outliers.
  for (int k = first ? 6 : 2; k > 0; --k) solve(measureSamples());
  updateResidual(sample);
  return true;
}

void InsertionPointEstimator::insert(const Sample& sample) {
  const double near = std::cos(config_.same_direction);
  int count = 0;
  Sample* oldest = nullptr;
  Sample* oldest_near = nullptr;
  for (Sample& other : samples_) {
    if (!oldest || other.time < oldest->time) oldest = &other;
    if (other.shaft.direction.dot(sample.shaft.direction) < near) continue;
    ++count;
    if (!oldest_near || other.time < oldest_near->time) oldest_near = &other;
  }
  if (count >= config_.samples_per_direction) {
    *oldest_near = sample;
  } else if (samples_.size() >= static_cast<std::size_t>(config_.max_samples)) {
    *oldest = sample;
  } else {
    samples_.push_back(sample);
  }
}

// Computes distances and their expected variances; returns the ratio of actual to expected distances, at least 1.
double InsertionPointEstimator::measureSamples() {
  const bool known = estimate_.valid || estimate_.smallest_eigenvalue > 0.0;
  scratch_.clear();
  for (Sample& sample : samples_) {
    const double along = known ? sample.shaft.direction.dot(estimate_.point - sample.shaft.point) : 0.0;
    sample.distance = known ? distanceFromLine(estimate_.point, sample.shaft) : 0.0;
    sample.variance = config_.position_noise * config_.position_noise + config_.wobble * config_.wobble +
                      config_.direction_noise * config_.direction_noise * along * along +
                      config_.drift * config_.drift * (time_ - sample.time);
    scratch_.push_back(sample.distance / std::sqrt(sample.variance));
  }
  return std::max(1.0, robust::median(scratch_) / robust::kRayleighMedian);
}

void InsertionPointEstimator::solve(double scale) {
  const Eigen::Vector3d origin = prior_ ? prior_->point : samples_.front().shaft.point;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  Eigen::Matrix3d bias = Eigen::Matrix3d::Zero();
  Eigen::Vector3d bias_vector = Eigen::Vector3d::Zero();
  double weights = 0.0;
  double ages = 0.0;
  const double noise = 2.0 * config_.direction_noise * config_.direction_noise;
  for (const Sample& sample : samples_) {
    const double variance = scale * scale * sample.variance;
    const double weight = robust::tukeyWeight(sample.distance / std::sqrt(variance)) / variance;
    const Eigen::Vector3d& a = sample.shaft.direction;
    const Eigen::Vector3d p = sample.shaft.point - origin;
    information += weight * (Eigen::Matrix3d::Identity() - a * a.transpose());
    vector += weight * (p - a * a.dot(p));
    bias += weight * noise * a * a.transpose();
    bias_vector += weight * noise * a * a.dot(p);
    weights += weight;
    ages += weight * (time_ - sample.time);
  }
  if (!(weights > 0.0)) return;
  // At most half of the information along the shaft: the noise may be less than configured.
  const double along = Eigen3d(information, Eigen::EigenvaluesOnly).eigenvalues()[0];
  const double share = std::min(1.0, 0.5 * along / std::max(bias.trace(), 1e-300));
  information -= share * bias;
  vector -= share * bias_vector;

  const Eigen3d axes(information);
  estimate_.smallest_eigenvalue = std::max(0.0, axes.eigenvalues()[0] / weights);
  const bool enough = samples_.size() >= static_cast<std::size_t>(config_.min_samples);
  estimate_.observable = enough && estimate_.smallest_eigenvalue >= config_.min_eigenvalue;
  estimate_.valid = prior_.has_value() || estimate_.observable;
  if (prior_) {
    // Directions that differ little more than by their noise must not move the estimate from the prior along the shaft.
    const Eigen::Vector3d axis = axes.eigenvectors().col(0);
    const double excess = std::max(0.0, 1.0 - estimate_.smallest_eigenvalue / config_.min_eigenvalue);
    information -= excess * axes.eigenvalues()[0] * axis * axis.transpose();
    vector -= excess * axis * axis.dot(vector);
    information.diagonal().array() += 1.0 / (prior_->stddev * prior_->stddev);
  }
  // Without a prior and without motion only a line is determined, no point.
  if (!prior_ && !(estimate_.smallest_eigenvalue > 1e-9)) return;
  const Eigen::Matrix3d inverse = information.inverse();
  estimate_.point = origin + inverse * vector;
  estimate_.covariance = 0.5 * (inverse + inverse.transpose());
  estimate_.covariance.diagonal().array() += config_.drift * config_.drift * ages / weights;
}

void InsertionPointEstimator::updateResidual(const Sample& sample) {
  const auto size = static_cast<std::size_t>(config_.residual_samples);
  if (recent_.size() < size) {
    recent_.push_back(sample);
  } else {
    recent_[next_recent_] = sample;
    next_recent_ = (next_recent_ + 1) % size;
  }
  if (!estimate_.valid) return;
  scratch_.clear();
  for (const Sample& one : recent_) scratch_.push_back(distanceFromLine(estimate_.point, one.shaft));
  residual_ = robust::median(scratch_) * std::sqrt(2.0) / robust::kRayleighMedian;
  if (recent_.size() < size) return;

  const double keep = 1.0 - config_.residual_hysteresis;
  const double stop = config_.stop_residual * (level_ == ResidualLevel::kStop ? keep : 1.0);
  const double warning = config_.warning_residual * (level_ != ResidualLevel::kOk ? keep : 1.0);
  level_ = residual_ < warning && residual_ < stop ? ResidualLevel::kOk
           : residual_ < stop                      ? ResidualLevel::kWarning
                                                   : ResidualLevel::kStop;  // also for NaN
}

ShaftDepth shaftDepth(const InsertionPointEstimate& estimate, const Shaft& camera, double length) {
  ShaftDepth depth;
  depth.d2 = camera.direction.dot(camera.point - estimate.point);
  depth.d1 = length - depth.d2;
  depth.lateral_offset = distanceFromLine(estimate.point, camera);
  depth.stddev = std::sqrt(std::max<double>(camera.direction.dot(estimate.covariance * camera.direction), 0.0));
  return depth;
}

std::optional<double> d1FromVelocities(const std::vector<geometry::Vector6d>& twists, double min_turn) {
  double moment = 0.0;
  double turn = 0.0;
  for (const geometry::Vector6d& t : twists) {
    moment += t[3] * t[1] - t[4] * t[0];  // eq. (12)
    turn += t[3] * t[3] + t[4] * t[4];
  }
  if (!(turn >= min_turn * min_turn && turn > 0.0) || !std::isfinite(moment / turn)) return std::nullopt;
  return moment / turn;
}

}  // namespace laparoscope_servo::servo
