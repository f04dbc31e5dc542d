#include "servo/task/parallel/plane_normal.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/robust/median.h"
#include "laparoscope_servo/robust/weights.h"

namespace laparoscope_servo::servo {

namespace {

constexpr std::size_t kFewest = 8;  // views; below, a scatter of the misfit says nothing
// Standard deviation of the factor on the arm's turns, before anything is seen of it: of an arm whose joints and
// velocities are a few percent wrong.
constexpr double kTurnError = 0.03;
// rad, the same of a step of the normal.
constexpr double kSlant = 1.0;
// Equations and unknowns of a view: 4 corners, and its own T.
constexpr int kEquations = 8, kOwn = 3;
// Normalised: 0.02 px at a focal length of 400 px, what is left between the motions of two images of good films,
// forward and backward (motion.md). The anchor itself has no error at all.
constexpr double kLeastNoise = 5e-5;
constexpr double kInFront = 1e-3;  // of the depth at the anchor: a corner nearer is behind the camera, or at infinity

using Rows = Eigen::Matrix<double, kEquations, 1>;
using RowsOfStep = Eigen::Matrix<double, kEquations, kOwn>;
using RowsOfShared = Eigen::Matrix<double, kEquations, 6>;

// Two unit vectors across n.
Eigen::Matrix<double, 3, 2> across(const Eigen::Vector3d& n) {
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = n.unitOrthogonal();
  basis.col(1) = n.cross(basis.col(0));
  return basis;
}

}  // namespace

Eigen::Matrix3d PlaneEstimate::corrected(const Eigen::Matrix3d& base_R_camera) const {
  return base_R_first * geometry::so3Exp(turn_factor * geometry::so3Log(base_R_first.transpose() * base_R_camera));
}

Eigen::Vector3d PlaneEstimate::normalOfPoses() const {
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ(), there = base_R_first.transpose() * normal;
  const Eigen::Vector3d turn = geometry::so3Log(Eigen::Quaterniond::FromTwoVectors(axis, there).toRotationMatrix());
  return base_R_first * (geometry::so3Exp(turn / turn_factor) * axis);
}

PlaneNormal::PlaneNormal() {
  views_.reserve(kMostViews);
  scratch_.reserve(kMostViews);
}

void PlaneNormal::restart() {
  views_.clear();
  estimate_ = PlaneEstimate();
  scale_ = 1.0;
}

// The points are those that the first view shows at its corners: they are in the picture as long as the scope is near.
void PlaneNormal::begin(const PlaneView& view) {
  const Eigen::Matrix3d back = view.motion.h.inverse();
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector3d p = back * view.motion.corners[k].homogeneous();
    anchor_[k] = p / p.z();
  }
  const double sign = view.motion.h.determinant() < 0.0 ? -1.0 : 1.0;  // a homography has none of its own
  first_R_anchor_ = geometry::nearestRotation(sign * view.motion.h);
  normal_ = first_R_anchor_.transpose() * Eigen::Vector3d::UnitZ();
  turn_error_ = 0.0;
  scale_ = 1.0;
  estimate_ = PlaneEstimate();
  estimate_.base_R_first = view.base_R_camera;
}

void PlaneNormal::add(const PlaneView& view) {
  const bool is_finite = view.motion.h.allFinite() && view.base_R_camera.allFinite() && view.camera.allFinite();
  if (!is_finite || !std::isfinite(view.motion.error) || views_.size() == kMostViews) return;
  if (views_.empty()) begin(view);
  Seen seen;
  for (std::size_t k = 0; k < 4; ++k) {
    seen.corners[k] = (view.motion.h * anchor_[k]).hnormalized();
    if (!anchor_[k].allFinite() || !seen.corners[k].allFinite()) return;
  }
  seen.noise = std::max(kLeastNoise, view.motion.error);
  seen.turn = geometry::so3Log(estimate_.base_R_first.transpose() * view.base_R_camera);
  seen.camera = view.camera;
  views_.push_back(seen);
  constexpr int kAtFirst = 10, kThen = 2;  // steps: from no estimate, and from the one of the view before
  estimate_.is_known = false;
  if (views_.size() < kFewest) return;
  for (int step = 0; step < (views_.size() == kFewest ? kAtFirst : kThen); ++step) {
    if (!improve()) return;
  }
  tell();
}

// T of a view, for the present normal and rotation: H x, x at the anchor, is along R x + T n'x, eq. (8) as a
// displacement.
void PlaneNormal::fitStep(Seen& seen) const {
  const Eigen::Matrix3d r = geometry::so3Exp(-(1.0 + turn_error_) * seen.turn) * first_R_anchor_;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector3d turned = r * anchor_[k];
    const double nearness = normal_.dot(anchor_[k]);
    for (int c = 0; c < 2; ++c) {
      const Eigen::Vector3d across_ray = seen.corners[k][c] * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::Unit(c);
      normal += nearness * nearness * across_ray * across_ray.transpose();
      right -= nearness * across_ray * across_ray.dot(turned);
    }
  }
  seen.step = normal.ldlt().solve(right);
}

// One step of Gauss-Newton, each view's own T eliminated. False: the views do not determine the rest.
bool PlaneNormal::improve() {
  const Eigen::Matrix<double, 3, 2> basis = across(normal_);
  Information information = Information::Zero();
  Shared right = Shared::Zero();
  for (Seen& seen : views_) {
    fitStep(seen);
    const Eigen::Matrix3d r = geometry::so3Exp(-(1.0 + turn_error_) * seen.turn) * first_R_anchor_;
    Rows left;
    RowsOfStep of_step;
    RowsOfShared of_shared;
    bool is_before = true;  // the camera
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Vector3d turned = r * anchor_[k];
      const double nearness = normal_.dot(anchor_[k]);
      const double depth = turned.z() + nearness * seen.step.z();
      is_before = is_before && depth > kInFront;
      for (int c = 0; c < 2; ++c) {
        const Eigen::Vector3d ray =
            (seen.corners[k][c] * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::Unit(c)) / (seen.noise * depth);
        const Eigen::Index row = 2 * static_cast<Eigen::Index>(k) + c;
        left[row] = ray.dot(turned + nearness * seen.step);
        of_step.row(row) = nearness * ray.transpose();
        of_shared.block<1, 2>(row, 0) = ray.dot(seen.step) * (anchor_[k].transpose() * basis);
        of_shared.block<1, 3>(row, 2) = anchor_[k].cross(r.transpose() * ray).transpose();
        of_shared(row, 5) = -ray.dot(seen.turn.cross(turned));
      }
    }
    if (!is_before || !left.allFinite()) {
      seen.misfit = std::numeric_limits<double>::infinity();
      continue;
    }
    seen.misfit = left.squaredNorm();
    const Eigen::Matrix3d own = of_step.transpose() * of_step;
    const Eigen::Matrix<double, kOwn, kShared> mixed = of_step.transpose() * of_shared;
    const Eigen::Matrix<double, kOwn, kShared> kept = own.ldlt().solve(mixed);
    information += seen.weight * (of_shared.transpose() * of_shared - mixed.transpose() * kept);
    right -= seen.weight * (of_shared.transpose() * left - kept.transpose() * (of_step.transpose() * left));
  }
  weigh();
  // The factor is near 1. The normal is only kept from going far in one step, where little is known of it.
  Shared prior = Shared::Zero();
  prior[5] = 1.0 / (kTurnError * kTurnError);
  prior.head<2>().setConstant(1.0 / (kSlant * kSlant));
  const double variance = scale_ * scale_;
  information += variance * Information(prior.asDiagonal());
  right[5] -= variance * prior[5] * turn_error_;
  const Eigen::LDLT<Information> solver(information);
  const Shared change = solver.solve(right);
  if (solver.info() != Eigen::Success || !solver.isPositive() || !change.allFinite()) return false;
  constexpr double kLongest = 0.3;  // rad, of a step: further off the problem is not linear
  const double shortened = std::min(1.0, kLongest / std::max(kLongest, change.norm()));
  normal_ = (normal_ + shortened * (basis * change.head<2>())).normalized();
  first_R_anchor_ = first_R_anchor_ * geometry::so3Exp(shortened * change.segment<3>(2));
  turn_error_ += shortened * change[5];
  information_ = information / variance;
  return true;
}

// Tukey's weights, by the robust scale of the views' misfit. The four corners of a view err alike where its pose does.
void PlaneNormal::weigh() {
  scratch_.clear();
  for (const Seen& seen : views_) scratch_.push_back(std::sqrt(seen.misfit / (kEquations - kOwn)));
  // Of a chi distribution with 5 degrees of freedom the median is 0.933 times its root mean square.
  constexpr double kMedian = 0.933;
  scale_ = std::max(1.0, robust::median(scratch_) / kMedian);
  for (Seen& seen : views_) {
    seen.weight = robust::tukeyWeight(std::sqrt(seen.misfit / (kEquations - kOwn)) / scale_);
  }
}

void PlaneNormal::tell() {
  PlaneEstimate& e = estimate_;
  const Eigen::Matrix3d base_R_anchor = e.base_R_first * first_R_anchor_;
  e.normal = base_R_anchor * normal_;
  e.normal_in_anchor = normal_;
  e.turn_factor = 1.0 + turn_error_;
  e.misfit = scale_;
  // n in the base moves by the change of n and by that of the anchor's rotation, d x n = -[n]x d.
  Eigen::Matrix<double, 3, kShared> by_shared = Eigen::Matrix<double, 3, kShared>::Zero();
  by_shared.leftCols<2>() = across(normal_);
  by_shared.block<3, 3>(0, 2) = -geometry::skew(normal_);
  const Information covariance = information_.inverse();
  const Eigen::Matrix3d of_normal = by_shared * covariance * by_shared.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(of_normal, Eigen::EigenvaluesOnly);
  e.stddev = std::sqrt(std::max(0.0, axes.eigenvalues()[2]));
  // base_R_camera T = (c_anchor - c) / d: its slope over the camera's place c is -1/d, in whatever way tissue moves.
  Eigen::Vector3d mean_step = Eigen::Vector3d::Zero(), mean_camera = Eigen::Vector3d::Zero();
  double total = 0.0;
  const auto inBase = [&](const Seen& seen) -> Eigen::Vector3d {
    return e.base_R_first * (geometry::so3Exp(e.turn_factor * seen.turn) * seen.step);
  };
  for (const Seen& seen : views_) {
    total += seen.weight;
    mean_step += seen.weight * inBase(seen);
    mean_camera += seen.weight * seen.camera;
  }
  mean_step /= total;
  mean_camera /= total;
  double both = 0.0, of_steps = 0.0, of_cameras = 0.0;
  for (const Seen& seen : views_) {
    const Eigen::Vector3d step = inBase(seen) - mean_step, camera = seen.camera - mean_camera;
    both -= seen.weight * step.dot(camera);
    of_steps += seen.weight * step.squaredNorm();
    of_cameras += seen.weight * camera.squaredNorm();
  }
  const double depth = of_cameras / both;  // of the anchor's centre over the plane
  e.agreement = both > 0.0 ? both * both / (of_steps * of_cameras) : 0.0;
  e.distance = depth + e.normal.dot(mean_camera + depth * mean_step);
  e.is_known = std::isfinite(e.stddev) && std::isfinite(e.distance) && both > 0.0;
}

}  // namespace laparoscope_servo::servo
