#include "laparoscope_servo/servo/insertion_point_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "laparoscope_servo/parameters/table.h"
#include "laparoscope_servo/robust/largest.h"
#include "laparoscope_servo/validation/error_report.h"

namespace laparoscope_servo::servo {

namespace {

using Eigen3d = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;  // eigenvalues ascending

const InsertionPointFitConfig& checked(const InsertionPointFitConfig& config) {
  validation::throwErrors("insertion point fit", validate(config));
  return config;
}

InsertionPointConfig estimatorConfig(const InsertionPointFitConfig& fit) {
  InsertionPointConfig config;
  config.position_noise = fit.position_noise;
  config.direction_noise = fit.direction_noise;
  config.wobble = fit.wobble;
  config.drift = 0.0;
  // The poses kept differ in direction already.
  config.same_direction = 0.0;
  config.samples_per_direction = 1000;
  config.max_samples = std::max(10, fit.max_poses);
  config.min_samples = 5;
  // With a smaller eigenvalue the place along the shaft would be undetermined.
  config.min_eigenvalue = 0.25 * std::pow(std::sin(fit.min_cone), 2);
  return config;
}

std::string problem(const char* what, double value, const char* expected, double bound, const char* unit,
                    const char* cure) {
  std::ostringstream text;
  text.precision(3);
  text << what << ' ' << value << unit << ", expected " << expected << ' ' << bound << unit << ": " << cure;
  return text.str();
}

}  // namespace

void describe(parameters::Table& table, InsertionPointFitConfig& c) {
  table.number("spacing", c.spacing, {0.001, 0.2}, "rad",
               "a pose is kept if its shaft's direction differs by at least this from all others");
  table.number("min_poses", c.min_poses, {5, 500}, "poses", "fewer are refused; at most half of max_poses");
  table.number("max_poses", c.max_poses, {10, 1000}, "poses", "when there are more, a wider spacing thins them out");
  table.number("min_cone", c.min_cone, {0.01, 0.5}, "rad",
               "least root mean square of the shaft's directions from their mean");
  table.number("max_residual", c.max_residual, {1e-4, 0.1}, "m",
               "root mean square distance of the shafts from the point");
  table.number("max_stddev", c.max_stddev, {1e-4, 0.1}, "m", "standard deviation of the point along its worst axis");
  table.number("position_noise", c.position_noise, {1e-6, 0.05}, "m", "assumed standard deviation of a pose per axis");
  table.number("direction_noise", c.direction_noise, {0, 0.1}, "rad",
               "assumed standard deviation of a shaft's direction per axis");
  table.number("wobble", c.wobble, {0, 0.05}, "m", "standard deviation of the point's motion with breathing");
}

std::vector<std::string> validate(const InsertionPointFitConfig& config) {
  std::vector<std::string> errors = parameters::errorsOf(config);
  if (config.min_poses > std::max(5, config.max_poses / 2)) {
    errors.push_back("min_poses = " + std::to_string(config.min_poses) +
                     ", expected at most half of max_poses = " + std::to_string(config.max_poses));
  }
  return errors;
}

InsertionPointFitter::InsertionPointFitter(const InsertionPointFitConfig& config)
    : config_(checked(config)), spacing_(config.spacing), estimator_(estimatorConfig(config)) {}

bool InsertionPointFitter::add(const Shaft& shaft) {
  if (!insert(shaft, taken_)) return false;
  ++taken_;
  // Keeps room for other directions, however long the shaft stays near one.
  while (shafts_.size() >= static_cast<std::size_t>(config_.max_poses)) thinOut();
  measure();
  return true;
}

bool InsertionPointFitter::insert(const Shaft& shaft, std::size_t number) {
  const double near = std::cos(spacing_);
  const auto is_near = [&](const Shaft& other) { return other.direction.dot(shaft.direction) > near; };
  if (std::any_of(shafts_.begin(), shafts_.end(), is_near)) return false;
  if (!estimator_.update(0.0, shaft)) return false;
  shafts_.push_back({shaft.point, shaft.direction.normalized()});
  kept_.push_back(number);
  return true;
}

void InsertionPointFitter::thinOut() {
  spacing_ *= 1.4;  // root of 2: halves the number of directions that fill a cone
  estimator_.reset();
  const std::vector<Shaft> shafts = std::move(shafts_);
  const std::vector<std::size_t> numbers = std::move(kept_);
  shafts_.clear();
  kept_.clear();
  for (std::size_t k = 0; k < shafts.size(); ++k) insert(shafts[k], numbers[k]);
}

void InsertionPointFitter::measure() {
  const InsertionPointEstimate& estimate = estimator_.estimate();
  fit_.poses = static_cast<int>(shafts_.size());
  fit_.known = estimate.valid;
  fit_.point = estimate.point;
  fit_.covariance = estimate.valid ? estimate.covariance : Eigen::Matrix3d::Zero().eval();
  fit_.stddev = std::sqrt(std::max(Eigen3d(fit_.covariance, Eigen::EigenvaluesOnly).eigenvalues()[2], 0.0));
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  double squares = 0.0;
  fit_.largest_residual = 0.0;
  for (const Shaft& shaft : shafts_) {
    const Eigen::Vector3d& a = shaft.direction;
    spread += (Eigen::Matrix3d::Identity() - a * a.transpose()) / static_cast<double>(fit_.poses);
    const double distance = a.cross(fit_.point - shaft.point).norm();
    const double along = a.dot(fit_.point - shaft.point);
    squares += distance * distance;
    fit_.largest_residual = robust::largest(fit_.largest_residual, distance);
    fit_.nearest = &shaft == shafts_.data() ? along : std::min(fit_.nearest, along);
    fit_.farthest = &shaft == shafts_.data() ? along : std::max(fit_.farthest, along);
  }
  const double smallest = Eigen3d(spread, Eigen::EigenvaluesOnly).eigenvalues()[0];
  fit_.cone = std::asin(std::sqrt(std::clamp(smallest, 0.0, 1.0)));
  fit_.residual = std::sqrt(squares / static_cast<double>(fit_.poses));
}

std::vector<std::string> InsertionPointFitter::problems(double length) const {
  std::vector<std::string> problems;
  const char* turn = "turn the scope further, to all sides";
  if (fit_.poses < config_.min_poses) {
    problems.push_back(problem("poses of different directions:", fit_.poses, "at least", config_.min_poses, "", turn));
  }
  if (!(fit_.cone >= config_.min_cone)) {
    problems.push_back(problem("the shaft has turned by", fit_.cone, "at least", config_.min_cone, " rad", turn));
  }
  if (!fit_.known) return problems.empty() ? std::vector<std::string>{"the shafts do not meet anywhere"} : problems;
  if (!(fit_.residual <= config_.max_residual)) {
    problems.push_back(problem("the shafts pass the point at", fit_.residual, "at most", config_.max_residual, " m",
                               "has the trocar moved, is the table of joints that of this arm?"));
  }
  if (!(fit_.stddev <= config_.max_stddev)) {
    problems.push_back(
        problem("the point's standard deviation is", fit_.stddev, "at most", config_.max_stddev, " m", turn));
  }
  if (!(fit_.nearest > 0.0 && fit_.farthest < length)) {
    std::ostringstream text;
    text.precision(3);
    text << "the point lies " << fit_.nearest << " to " << fit_.farthest
         << " m along the shaft, expected above 0 and below its length of " << length << " m";
    problems.push_back(text.str());
  }
  return problems;
}

}  // namespace laparoscope_servo::servo
