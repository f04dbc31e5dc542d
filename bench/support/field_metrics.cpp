#include "bench/support/field_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace laparoscope_servo::bench {

namespace {

double ratio(double part, double whole) {
  return whole > 0.0 ? part / whole : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<Eigen::Vector2d> regionPoints(const geometry::Rectangle& roi) {
  std::vector<Eigen::Vector2d> points;
  const auto centre = [](double start, double length, int k) {
    return start + length * (k + 0.5) / kAreasAcross - 0.5;
  };
  for (int row = 0; row < kAreasAcross; ++row) {
    for (int column = 0; column < kAreasAcross; ++column)
      points.emplace_back(centre(roi.x, roi.width, column), centre(roi.y, roi.height, row));
  }
  return points;
}

std::vector<double> distances(const Eigen::Matrix3d& g, const Eigen::Matrix3d& truth,
                              const std::vector<Eigen::Vector2d>& points) {
  std::vector<double> result;
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector3d p = g * point.homogeneous();
    const Eigen::Vector3d q = truth * point.homogeneous();
    result.push_back(p.z() > 0.0 ? (p.hnormalized() - q.hnormalized()).norm()
                                 : std::numeric_limits<double>::infinity());
  }
  return result;
}

std::vector<char> visiblePoints(const Eigen::Matrix3d& truth, const std::vector<Eigen::Vector2d>& points,
                                const std::vector<double>& covered, const cv::Size& image) {
  if (!covered.empty() && covered.size() != points.size())
    throw std::invalid_argument(std::to_string(covered.size()) + " areas, expected " + std::to_string(points.size()));
  std::vector<char> result;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Eigen::Vector3d p = truth * points[k].homogeneous();
    const Eigen::Vector2d q = p.hnormalized();
    const bool inside =
        p.z() > 0.0 && q.x() >= 0.0 && q.y() >= 0.0 && q.x() <= image.width - 1.0 && q.y() <= image.height - 1.0;
    result.push_back(inside && (covered.empty() || covered[k] < 0.5) ? 1 : 0);
  }
  return result;
}

void PointScores::add(const std::vector<double>& distance, const std::vector<char>& visible, bool claimed) {
  for (std::size_t k = 0; k < distance.size(); ++k) {
    const bool seen = visible.at(k) != 0;
    visible_ += seen ? 1.0 : 0.0;
    for (std::size_t t = 0; t < kThresholds.size(); ++t) {
      const bool right = seen && distance[k] < kThresholds[t];
      near_[t] += right ? 1.0 : 0.0;
      near_and_claimed_[t] += right && claimed ? 1.0 : 0.0;
      wrongly_claimed_[t] += claimed && !right ? 1.0 : 0.0;
    }
  }
}

double PointScores::averageJaccard() const {
  double sum = 0.0;
  for (std::size_t t = 0; t < kThresholds.size(); ++t)
    sum += ratio(near_and_claimed_[t], visible_ + wrongly_claimed_[t]);
  return sum / static_cast<double>(kThresholds.size());
}

double PointScores::averageAccuracy() const {
  return shareOfVisible(near_);
}

double PointScores::averageClaimedAccuracy() const {
  return shareOfVisible(near_and_claimed_);
}

double PointScores::shareOfVisible(const Counts& counts) const {
  const double sum = std::accumulate(counts.begin(), counts.end(), 0.0);
  return ratio(sum / static_cast<double>(counts.size()), visible_);
}

double alignmentError(const Eigen::Matrix3d& g, const Eigen::Matrix3d& truth, const geometry::Rectangle& roi) {
  const geometry::Quadrilateral corners = roi.corners();
  double sum = 0.0;
  for (const double d : distances(g, truth, {corners.begin(), corners.end()})) sum += d * d;
  return std::sqrt(sum / static_cast<double>(corners.size()));
}

double precision(const std::vector<double>& errors, double limit) {
  const auto within = std::count_if(errors.begin(), errors.end(), [limit](double e) { return e < limit; });
  return ratio(static_cast<double>(within), static_cast<double>(errors.size()));
}

}  // namespace laparoscope_servo::bench
