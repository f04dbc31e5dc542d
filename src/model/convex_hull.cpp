#include "model/convex_hull.h"

#include <algorithm>

namespace laparoscope_servo::model {

namespace {

bool isBefore(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
}

// Drops what `next` makes a corner that is none, down to the first `kept` corners, and adds `next`.
void add(const Eigen::Vector2d& next, std::size_t kept, std::vector<Eigen::Vector2d>& hull) {
  while (hull.size() > kept) {
    const Eigen::Vector2d last = hull.back() - hull[hull.size() - 2], step = next - hull.back();
    if (last.x() * step.y() - last.y() * step.x() > 0.0) break;
    hull.pop_back();
  }
  hull.push_back(next);
}

}  // namespace

// Andrew's monotone chain: one side of the hull from the first point to the last one, then the other side back.
void convexHull(std::vector<Eigen::Vector2d>& points, std::vector<Eigen::Vector2d>& hull) {
  hull.clear();
  std::sort(points.begin(), points.end(), isBefore);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  for (const Eigen::Vector2d& point : points) add(point, 1, hull);
  if (points.size() < 3) return;
  const std::size_t there = hull.size();
  for (auto point = points.rbegin() + 1; point != points.rend(); ++point) add(*point, there, hull);
}

}  // namespace laparoscope_servo::model
