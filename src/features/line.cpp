#include "laparoscope_servo/features/line.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::features {

namespace {

constexpr int kProbes = 4;           // sites beyond each end
constexpr int kEndRun = 4;           // sites, of which all but one are seen where the line begins
constexpr double kRemembered = 2.0;  // s

double turned(double angle) {
  return std::atan2(std::sin(angle), std::cos(angle));
}

}  // namespace

Line::Line(const Eigen::Vector2d& begin, const Eigen::Vector2d& end) {
  const Eigen::Vector2d along = end - begin;
  const double farthest = std::max(begin.lpNorm<Eigen::Infinity>(), end.lpNorm<Eigen::Infinity>());
  if (!(along.norm() >= kMinLength && begin.allFinite() && end.allFinite() && farthest < kFarthest)) {
    std::ostringstream text;
    text << "line from (" << begin.x() << ", " << begin.y() << ") to (" << end.x() << ", " << end.y()
         << "), expected finite ends at least " << kMinLength << " px apart, below 100000 px";
    throw std::invalid_argument(text.str());
  }
  theta_ = std::atan2(-along.x(), along.y());
  anchor_ = 0.5 * (begin + end);
  begin_ = seen_begin_ = -0.5 * along.norm();
  end_ = seen_end_ = 0.5 * along.norm();
}

Eigen::Vector2d Line::normal() const {
  return {std::cos(theta_), std::sin(theta_)};
}

Eigen::Vector2d Line::direction() const {
  return {-std::sin(theta_), std::cos(theta_)};
}

// Displacement of the point at s from the middle: d rho - s d theta, with the step (d rho, h d theta), h half the
// length.
void Line::sites(double spacing, int most, std::vector<Site>& result) const {
  result.clear();
  if (!std::isfinite(begin_) || !std::isfinite(end_)) return;  // before the casts
  const double half = 0.5 * (end_ - begin_), middle = 0.5 * (begin_ + end_);
  const int stride = std::max(1, static_cast<int>(std::ceil((end_ - begin_) / spacing / most)));
  const int lowest = -(kSlots / 2 - 1), highest = kSlots / 2 - 1;
  int first = static_cast<int>(std::ceil(std::clamp(begin_ / spacing, -1e6, 1e6)));
  int last = static_cast<int>(std::floor(std::clamp(end_ / spacing, -1e6, 1e6)));
  const Eigen::Vector2d along = direction(), across = normal();
  first = (first >= 0 ? (first + stride - 1) / stride : first / stride) * stride;
  for (int k = first - kProbes * stride; k <= last + kProbes * stride; k += stride) {
    if (k < lowest || k > highest) continue;
    Site site;
    site.probe = k < first || k > last;
    site.slot = k - lowest;
    site.point = anchor_ + k * spacing * along;
    site.normal = across;
    site.count = 2;
    site.jacobian = {1.0, -(k * spacing - middle) / half};
    result.push_back(site);
  }
}

void Line::move(const Eigen::VectorXd& step) {
  const double half = 0.5 * (end_ - begin_), middle = 0.5 * (begin_ + end_);
  const Eigen::Vector2d centre = at(middle) + step[0] * normal();
  theta_ = turned(theta_ + step[1] / half);
  anchor_ = centre - middle * direction();
}

void Line::transform(const Eigen::Matrix3d& motion) {
  const Eigen::Vector2d b = geometry::apply(motion, at(begin_)), e = geometry::apply(motion, at(end_));
  const Eigen::Vector2d seen_b = geometry::apply(motion, begin()), seen_e = geometry::apply(motion, end());
  const Eigen::Vector2d a = geometry::apply(motion, anchor_), along = e - b;
  theta_ = std::atan2(-along.x(), along.y());
  anchor_ = b + direction() * direction().dot(a - b);
  begin_ = direction().dot(b - anchor_);
  end_ = direction().dot(e - anchor_);
  seen_begin_ = direction().dot(seen_b - anchor_);
  seen_end_ = direction().dot(seen_e - anchor_);
}

void Line::settle(const std::vector<SiteFinding>& findings, const Eigen::MatrixXd&, double passed) {
  const int count = static_cast<int>(findings.size());
  const auto isSeen = [&](int i) { return i >= 0 && i < count && findings[static_cast<std::size_t>(i)].weight > 0.0; };
  // From `i` on towards the other end nearly all is seen.
  const auto starts = [&](int i, int step) {
    int seen = 0;
    for (int k = 0; k < kEndRun; ++k) seen += isSeen(i + k * step) ? 1 : 0;
    return isSeen(i) && seen >= kEndRun - 1;
  };
  int first = 0, last = count - 1;
  while (first < count && !starts(first, 1)) ++first;
  while (last >= 0 && !starts(last, -1)) --last;
  if (first >= last) return;
  const Eigen::Vector2d line = direction();
  const auto along = [&](int i) { return line.dot(findings[static_cast<std::size_t>(i)].point - anchor_); };
  const double half_gap = 0.5 * (along(last) - along(first)) / (last - first);
  if (!(along(last) - along(first) + 2.0 * half_gap >= kMinLength)) return;
  seen_begin_ = along(first) - half_gap;
  seen_end_ = along(last) + half_gap;
  // What is covered now may come back; what is not seen for longer is no part of it.
  const double forgotten = std::clamp(passed / kRemembered, 0.0, 1.0);
  begin_ = seen_begin_ < begin_ ? seen_begin_ : begin_ + forgotten * (seen_begin_ - begin_);
  end_ = seen_end_ > end_ ? seen_end_ : end_ + forgotten * (seen_end_ - end_);
}

void Line::known(const Curve&, double range, Eigen::MatrixXd& information, Eigen::VectorXd& mean) const {
  information.setIdentity(2, 2);
  information /= range * range;
  mean.setZero(2);
}

bool Line::isSound() const {
  return std::isfinite(theta_) && anchor_.allFinite() && end_ - begin_ >= 0.5 * kMinLength && end_ - begin_ < kFarthest;
}

// How much of it is seen is no change of the line.
double Line::change(const Curve&) const {
  return 1.0;
}

Eigen::Matrix2d Line::covariance(const Eigen::MatrixXd& of_parameters) const {
  const double half = 0.5 * (end_ - begin_), middle = 0.5 * (begin_ + end_);
  Eigen::Matrix2d derivative;
  derivative << 1.0, direction().dot(at(middle)) / half, 0.0, 1.0 / half;
  const Eigen::Matrix2d own = of_parameters;  // of fixed size: the product does not allocate
  return derivative * own * derivative.transpose();
}

}  // namespace laparoscope_servo::features
