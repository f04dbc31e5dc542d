#include "features/shafts/shaft.h"

#include <algorithm>
#include <cmath>

#include "features/shafts/grey_map.h"

namespace laparoscope_servo::features {

namespace {

constexpr double kTurned = 0.94;  // cosine of 20 degrees, between the axes of one shaft in two pictures
constexpr int kSamples = 10;      // along a shaft

bool isInside(const image::FieldOfView& view, const Eigen::Vector2d& p) {
  const cv::Point cell = GreyMap::cellOf(p);
  return view.contains(cell.x, cell.y);
}

int inside(const Shaft& a, const Shaft& b) {
  int count = 0;
  for (int i = 0; i <= kSamples; ++i) {
    const Eigen::Vector2d p = b.at(b.length * i / kSamples);
    const double along = a.axis.dot(p - a.entry);
    const bool between = a.edges[0].distance(p) < 0.0 && a.edges[1].distance(p) < 0.0;
    count += between && along > -0.5 * a.length && along < 1.5 * a.length ? 1 : 0;
  }
  return count;
}

}  // namespace

double Shaft::widthAt(double along) const {
  const Eigen::Vector2d p = at(along);
  return -edges[0].distance(p) - edges[1].distance(p);
}

void follow(const image::FieldOfView& view, const std::array<GreyLine, 2>& edges, Shaft& shaft) {
  shaft.edges = edges;
  // Directions that point to the tip: edge 1's own, and edge 0's turned round.
  shaft.axis = (edges[1].direction() - edges[0].direction()).normalized();
  const Eigen::Vector2d side(-shaft.axis.y(), shaft.axis.x());
  const auto meet = [&](const Eigen::Vector2d& p, const GreyLine& e) { return -e.distance(p) / e.normal.dot(side); };
  const Eigen::Vector2d some = 0.5 * (edges[0].point + edges[1].point);
  const Eigen::Vector2d middle = some + 0.5 * (meet(some, edges[0]) + meet(some, edges[1])) * side;
  double low = 1e9, high = -1e9;
  for (std::size_t k = 0; k < 2; ++k) {
    if (!shaft.seen[k]) continue;
    for (const double t : {edges[k].begin, edges[k].end}) {
      const double along = shaft.axis.dot(edges[k].at(t) - middle);
      low = std::min(low, along);
      high = std::max(high, along);
    }
  }
  // To the border, from where an edge is seen.
  double first = low;
  while (first > low - 1000.0 && isInside(view, middle + first * shaft.axis)) first -= 1.0;
  shaft.entry = middle + first * shaft.axis;
  shaft.length = high - first;
  shaft.width = shaft.widthAt(0.0);
}

bool isSame(const Shaft& a, const Shaft& b) {
  return a.axis.dot(b.axis) > kTurned && inside(a, b) + inside(b, a) >= kSamples;
}

bool overlaps(const Shaft& a, const Shaft& b) {
  return std::max(inside(a, b), inside(b, a)) >= kSamples / 2;
}

}  // namespace laparoscope_servo::features
