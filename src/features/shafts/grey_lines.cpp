#include "features/shafts/grey_lines.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace laparoscope_servo::features {

namespace {

constexpr int kAngles = 72;              // over the full circle, since normals have a sign
constexpr int kSpread = 3;               // angles either side that a point votes for: its gradient is that uncertain
constexpr int kMost = 24;                // lines
constexpr int kLeastVotes = 8;           // points, of a line
constexpr double kNear = 1.0;            // cells, of a point from its line
constexpr double kParallel = 0.87;       // cosine, of a point's normal with the line's
constexpr double kGap = 5.0;             // cells of a line without a point
constexpr int kMargin = 2;               // cells from the border, where the outline is that of the picture
constexpr float kLeastContrast = 0.08f;  // of colour, across an outline that counts
constexpr double kPi = 3.14159265358979323846;

}  // namespace

void GreyLines::collect(const GreyMap& map, const image::FieldOfView& view, double threshold) {
  points_.clear();
  const cv::Mat1b& c = map.colour();
  const int limit = static_cast<int>(threshold);
  for (int y = kMargin; y < map.rows() - kMargin; ++y) {
    for (int x = kMargin; x < map.columns() - kMargin; ++x) {
      if (c(y, x) >= limit || !view.isDeep(x, y, kMargin)) continue;
      for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const int out = c(y + dy, x + dx);
        if (out < limit) continue;
        const float gx =
            static_cast<float>(c(y, x + 1) - c(y, x - 1)) +
            0.5f * static_cast<float>(c(y - 1, x + 1) - c(y - 1, x - 1) + c(y + 1, x + 1) - c(y + 1, x - 1));
        const float gy =
            static_cast<float>(c(y + 1, x) - c(y - 1, x)) +
            0.5f * static_cast<float>(c(y + 1, x - 1) - c(y - 1, x - 1) + c(y + 1, x + 1) - c(y - 1, x + 1));
        const float size = std::hypot(gx, gy);
        if (!(size > 0.0f)) continue;
        OutlinePoint p;
        p.normal = {gx / size, gy / size};
        const float share = static_cast<float>(limit - c(y, x)) / static_cast<float>(std::max(1, out - c(y, x)));
        p.at = {static_cast<float>(x) + share * static_cast<float>(dx),
                static_cast<float>(y) + share * static_cast<float>(dy)};
        const auto level = [&](float along) {
          const int i =
              std::clamp(static_cast<int>(std::lround(p.at.x() + along * p.normal.x())), 0, map.columns() - 1);
          const int j = std::clamp(static_cast<int>(std::lround(p.at.y() + along * p.normal.y())), 0, map.rows() - 1);
          return static_cast<float>(c(j, i));
        };
        p.contrast = (level(2.0f) - level(-2.0f)) / static_cast<float>(GreyMap::kUnit);
        p.used = false;
        if (p.contrast >= kLeastContrast) points_.push_back(p);
      }
    }
  }
}

void GreyLines::vote(const OutlinePoint& point, int sign) {
  const double angle = std::atan2(point.normal.y(), point.normal.x());
  const int centre = static_cast<int>(std::lround(angle / (2.0 * kPi) * kAngles));
  for (int k = centre - kSpread; k <= centre + kSpread; ++k) {
    const int bin = (k % kAngles + kAngles) % kAngles;
    const double a = 2.0 * kPi * bin / kAngles;
    rows_[static_cast<std::size_t>(bin)].stale = true;
    const double rho = point.at.x() * std::cos(a) + point.at.y() * std::sin(a);
    const int r = static_cast<int>(std::lround(rho)) + rho_zero_;
    if (r < 1 || r >= rho_bins_ - 1) continue;
    for (int d = -1; d <= 1; ++d) {
      auto& cell = votes_[static_cast<std::size_t>(bin * rho_bins_ + r + d)];
      cell = static_cast<std::int16_t>(cell + sign);
    }
  }
}

bool GreyLines::isOn(const OutlinePoint& point, const GreyLine& line, double tolerance) const {
  const Eigen::Vector2d p = point.at.cast<double>();
  return !point.used && std::abs(line.distance(p)) <= tolerance &&
         point.normal.cast<double>().dot(line.normal) >= kParallel;
}

// Least squares on the points near the line, then its longest piece without a gap.
bool GreyLines::refine(GreyLine& line) {
  for (const double tolerance : {2.0, 1.5, kNear}) {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
    along_.clear();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!isOn(points_[i], line, tolerance)) continue;
      along_.emplace_back(line.direction().dot(points_[i].at.cast<double>() - line.point), i);
    }
    std::sort(along_.begin(), along_.end());
    std::size_t best_first = 0, best_count = 0, first = 0;
    for (std::size_t i = 0; i < along_.size(); ++i) {
      if (i > 0 && along_[i].first - along_[i - 1].first > kGap) first = i;
      if (i - first + 1 > best_count) {
        best_count = i - first + 1;
        best_first = first;
      }
    }
    if (best_count < kLeastVotes) return false;
    for (std::size_t i = best_first; i < best_first + best_count; ++i)
      mean += points_[along_[i].second].at.cast<double>();
    mean /= static_cast<double>(best_count);
    double contrast = 0.0;
    for (std::size_t i = best_first; i < best_first + best_count; ++i) {
      const Eigen::Vector2d d = points_[along_[i].second].at.cast<double>() - mean;
      square += d * d.transpose();
      contrast += static_cast<double>(points_[along_[i].second].contrast);
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(square);
    Eigen::Vector2d normal = solver.eigenvectors().col(0);
    if (normal.dot(line.normal) < 0.0) normal = -normal;
    const Eigen::Vector2d old = line.point, direction = line.direction();
    line.point = mean;
    line.normal = normal;
    line.begin = line.direction().dot(old + along_[best_first].first * direction - mean);
    line.end = line.direction().dot(old + along_[best_first + best_count - 1].first * direction - mean);
    line.support = static_cast<int>(best_count);
    line.contrast = contrast / static_cast<double>(best_count);
  }
  return true;
}

const std::vector<GreyLine>& GreyLines::find(const GreyMap& map, const image::FieldOfView& view, double threshold) {
  lines_.clear();
  collect(map, view, threshold);
  const int reach = static_cast<int>(std::ceil(std::hypot(map.columns(), map.rows()))) + 2;
  rho_bins_ = 2 * reach + 1;
  rho_zero_ = reach;
  votes_.assign(static_cast<std::size_t>(kAngles * rho_bins_), 0);
  rows_.assign(kAngles, Row());
  for (const OutlinePoint& p : points_) vote(p, 1);
  for (int tried = 0; tried < 2 * kMost && static_cast<int>(lines_.size()) < kMost; ++tried) {
    for (int a = 0; a < kAngles; ++a) {
      Row& row = rows_[static_cast<std::size_t>(a)];
      if (!row.stale) continue;
      const auto first = votes_.begin() + a * rho_bins_;
      const auto most = std::max_element(first, first + rho_bins_);
      row = {*most, static_cast<int>(most - first), false};
    }
    const auto best =
        std::max_element(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) { return a.most < b.most; });
    if (best->most < kLeastVotes) break;
    const int angle_bin = static_cast<int>(best - rows_.begin());
    const double angle = 2.0 * kPi * angle_bin / kAngles;
    const auto ignore = [&] {
      votes_[static_cast<std::size_t>(angle_bin * rho_bins_ + best->at)] = 0;
      best->stale = true;
    };
    GreyLine line;
    line.normal = {std::cos(angle), std::sin(angle)};
    line.point = (best->at - rho_zero_) * line.normal;
    if (!refine(line)) {
      ignore();
      continue;
    }
    lines_.push_back(line);
    bool any = false;
    for (OutlinePoint& p : points_) {
      if (!isOn(p, line, 1.5 * kNear)) continue;
      const double along = line.direction().dot(p.at.cast<double>() - line.point);
      if (along < line.begin - 1.0 || along > line.end + 1.0) continue;
      vote(p, -1);
      p.used = any = true;
    }
    if (!any) ignore();
  }
  return lines_;
}

}  // namespace laparoscope_servo::features
