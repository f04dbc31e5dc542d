#include "features/shafts/shaft_finder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace laparoscope_servo::features {

namespace {

constexpr double kAntiparallel =
    0.8;                             // cosine: perspective lets the edges of a near shaft converge by up to 37 degrees
constexpr double kLeastWidth = 3.0;  // cells
constexpr double kMostWidth = 0.6;   // of the picture's rows
constexpr double kElongated = 1.0;   // length over width at least
constexpr double kLeastOverlap = 0.4;    // of the shorter edge, along the axis, beside the other one
constexpr double kCoverage = 0.35;       // of the shaft's length that each edge is seen
constexpr double kTaper = 0.85;          // of the width at the far end, that the entry has at least: it is nearer
constexpr double kContrast = 0.45;       // of the way from grey to the picture's usual colour, across each edge
constexpr double kLeastContrast = 0.25;  // units of S0 cos H / mean
constexpr double kFill = 0.75;           // of grey between the edges
constexpr double kEntryFill = 0.6;       // the same between their ends and the border
constexpr double kEntersAt = 0.26;       // sine of the least angle between axis and border: 15 degrees
constexpr double kSingleLength = 0.25;   // of the picture's diagonal: an edge whose partner is out of the picture
constexpr double kSingleDepth = 0.35;    // of the picture's rows: how far away the border may be then

// What lies between the edges of a shaft: how much of it is grey, and how grey.
class Inside {
 public:
  Inside(const GreyMap& map, double threshold) : map_(map), threshold_(threshold) {}
  void add(const Eigen::Vector2d& p) {
    const cv::Point cell = GreyMap::cellOf(p);
    ++counts_[map_.contains(cell.x, cell.y) ? map_.colour()(cell) : 255];
    ++all_;
  }
  double fill() const { return share(std::ceil(threshold_)); }
  // That nine tenths stay below, over the threshold.
  double colour() const {
    int level = 0;
    while (level < 255 && share(level + 1.0) < kMostly) ++level;
    return (level - GreyMap::kZero) / (threshold_ - GreyMap::kZero);
  }

 private:
  static constexpr double kMostly = 0.9;
  double share(double below) const {
    const auto end = counts_.begin() + static_cast<std::ptrdiff_t>(std::min(below, 256.0));
    return all_ > 0 ? static_cast<double>(std::accumulate(counts_.begin(), end, 0)) / all_ : 0.0;
  }

  const GreyMap& map_;
  double threshold_;
  std::array<int, 256> counts_{};
  int all_ = 0;
};

}  // namespace

bool ShaftFinder::Scene::isInside(const Eigen::Vector2d& p) const {
  const cv::Point cell = GreyMap::cellOf(p);
  return map.contains(cell.x, cell.y) && view.contains(cell.x, cell.y);
}

bool ShaftFinder::Scene::isGrey(const Eigen::Vector2d& p) const {
  const cv::Point cell = GreyMap::cellOf(p);
  return map.contains(cell.x, cell.y) && map.colour()(cell) < threshold;
}

// From the axis at `from`, backwards to the border: grey all the way? Then the entry is known.
bool ShaftFinder::enter(const Scene& scene, Shaft& shaft, double from, double& length) const {
  const Eigen::Vector2d start = shaft.entry + from * shaft.axis;
  int grey = 0, all = 0;
  double t = 0.0;
  for (; scene.isInside(start - t * shaft.axis) && t < 1000.0; t += 1.0) {
    const Eigen::Vector2d p = start - t * shaft.axis, side(-shaft.axis.y(), shaft.axis.x());
    const double half = 0.3 * shaft.widthAt(from - t);
    for (const double k : {-1.0, 0.0, 1.0}) {
      if (!scene.isInside(p + k * half * side)) continue;
      ++all;
      grey += scene.isGrey(p + k * half * side) ? 1 : 0;
    }
  }
  if (grey < kEntryFill * all) return false;
  length = t;
  return true;
}

bool ShaftFinder::pair(const Scene& scene, const GreyLine& a, const GreyLine& b, Shaft& shaft) const {
  if (!(a.normal.dot(b.normal) < -kAntiparallel)) return false;
  if (!(std::min(a.contrast, b.contrast) >= scene.contrast)) return false;
  if (!(a.distance(b.at(0.5 * (b.begin + b.end))) < -kLeastWidth) ||
      !(b.distance(a.at(0.5 * (a.begin + a.end))) < -kLeastWidth))
    return false;
  // Which of them is edge 0 depends on the end at which it enters; until that is known, a is.
  Eigen::Vector2d axis = (b.direction() - a.direction()).normalized();
  const Eigen::Vector2d origin = 0.5 * (a.point + b.point);
  const auto interval = [&](const GreyLine& line, double& low, double& high) {
    const double p = axis.dot(line.at(line.begin) - origin), q = axis.dot(line.at(line.end) - origin);
    low = std::min(p, q);
    high = std::max(p, q);
  };
  double low_a, high_a, low_b, high_b;
  interval(a, low_a, high_a);
  interval(b, low_b, high_b);
  const double low = std::max(low_a, low_b), high = std::min(high_a, high_b);
  if (!(high - low >= kLeastOverlap * std::min(a.length(), b.length()))) return false;

  // The axis runs through the middle between the edges.
  const auto middle = [&](double along) {
    const Eigen::Vector2d p = origin + along * axis, side(-axis.y(), axis.x());
    // Where the line across the axis meets an edge.
    const auto meet = [&](const GreyLine& line) { return -line.distance(p) / line.normal.dot(side); };
    return Eigen::Vector2d(p + 0.5 * (meet(a) + meet(b)) * side);
  };
  const Eigen::Vector2d first = middle(std::min(low_a, low_b)), last = middle(std::max(high_a, high_b));
  shaft.edges = {a, b};
  shaft.axis = (last - first).normalized();
  shaft.entry = first;
  const double span = (last - first).norm();

  Inside inside(scene.map, scene.threshold);
  const Eigen::Vector2d side(-shaft.axis.y(), shaft.axis.x());
  for (int i = 0; i <= 16; ++i) {
    const double along = (low + (high - low) * i / 16.0) - std::min(low_a, low_b);
    const double half = 0.5 * shaft.widthAt(along);
    if (!(half > 0.5 * kLeastWidth)) return false;
    for (const double k : {-0.75, -0.4, 0.0, 0.4, 0.75}) {
      inside.add(shaft.entry + along * shaft.axis + k * half * side);
    }
  }
  shaft.fill = inside.fill();
  if (!(shaft.fill >= kFill)) return false;

  // Which end is the entry? The one from which grey goes on to the border; of two, the wider one, which is nearer.
  double back = 0.0, ahead = 0.0;
  const bool at_first = enter(scene, shaft, 0.0, back);
  Shaft reversed = shaft;
  std::swap(reversed.edges[0], reversed.edges[1]);
  reversed.axis = -shaft.axis;
  reversed.entry = last;
  const bool at_last = enter(scene, reversed, 0.0, ahead);
  if (!at_first && !at_last) return false;
  if (at_last && (!at_first || reversed.widthAt(0.0) > shaft.widthAt(0.0))) {
    shaft = reversed;
    back = ahead;
  }
  shaft.entry -= back * shaft.axis;
  shaft.length = span + back;
  shaft.width = shaft.widthAt(back);
  shaft.coverage = std::min(a.length(), b.length()) / shaft.length;
  if (!(shaft.coverage >= kCoverage)) return false;
  if (!(shaft.width >= kTaper * shaft.widthAt(shaft.length))) return false;
  if (!(shaft.width <= kMostWidth * scene.map.rows()) || !(shaft.length >= kElongated * shaft.width)) return false;
  // How steeply it comes in: at a shallow angle to the border it is something that lies along it.
  const Eigen::Vector2d across(-shaft.axis.y(), shaft.axis.x());
  const double reach = 0.5 * std::max(shaft.widthAt(0.0), kLeastWidth);
  double ends[2];
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector2d start = shaft.entry + back * shaft.axis + (k == 0 ? -1 : 1) * 0.5 * reach * across;
    double t = -back - 1.0;
    while (t < 500.0 && scene.isInside(start - (t + back) * shaft.axis)) t += 1.0;
    ends[k] = t;
  }
  const double slope = std::abs(ends[1] - ends[0]) / std::max(1.0, reach);
  if (slope > 1.0 / kEntersAt) return false;
  const double seen = std::min(1.0, (high - low) / std::max(1.0, std::max(high_a, high_b) - std::min(low_a, low_b)));
  shaft.clarity = std::min(a.contrast, b.contrast) / scene.usual;
  shaft.colour = inside.colour();
  shaft.score = shaft.fill * (a.support + b.support) * (0.5 + 0.5 * seen);
  return true;
}

bool ShaftFinder::single(const Scene& scene, const GreyLine& line, Shaft& shaft) const {
  const double diagonal = std::hypot(scene.map.columns(), scene.map.rows());
  if (!(line.length() >= kSingleLength * diagonal && line.contrast >= scene.contrast)) return false;
  Inside inside(scene.map, scene.threshold);
  double depth[2] = {0.0, 0.0}, deepest = 0.0;
  for (int i = 0; i <= 16; ++i) {
    const Eigen::Vector2d p = line.at(line.begin + line.length() * i / 16.0);
    double t = 1.5;
    for (; scene.isInside(p - t * line.normal); t += 1.0) {
      if (t > kSingleDepth * scene.map.rows()) return false;
      inside.add(p - t * line.normal);
    }
    deepest = std::max(deepest, t);
    depth[i < 8 ? 0 : 1] += t;
  }
  shaft.fill = inside.fill();
  if (!(shaft.fill >= kFill) || deepest < kLeastWidth) return false;
  // The border has to cut it off at an angle: what lies along the border is the border.
  if (!(std::abs(depth[1] - depth[0]) / 8.5 > kEntersAt * 0.5 * 0.5 * line.length())) return false;
  const bool left = depth[1] < depth[0];  // deeper at its begin: that is where it enters, and the axis is the direction
  shaft.axis = left ? line.direction() : Eigen::Vector2d(-line.direction());
  const int own = left ? 1 : 0;
  const Eigen::Vector2d from = line.at(left ? line.begin : line.end);
  double back = 0.0;
  while (back < 1000.0 && scene.isInside(from - 1.5 * line.normal - back * shaft.axis)) back += 1.0;
  shaft.width = 2.0 * deepest;
  shaft.edges[static_cast<std::size_t>(own)] = line;
  GreyLine& other = shaft.edges[static_cast<std::size_t>(1 - own)];
  other = line;
  other.normal = -line.normal;
  other.point = line.point - shaft.width * line.normal;
  other.begin = -line.end;
  other.end = -line.begin;
  shaft.seen[static_cast<std::size_t>(own)] = true;
  shaft.seen[static_cast<std::size_t>(1 - own)] = false;
  shaft.entry = from - back * shaft.axis - 0.5 * shaft.width * line.normal;
  shaft.length = line.length() + back;
  shaft.coverage = line.length() / shaft.length;
  shaft.clarity = line.contrast / scene.usual;
  shaft.colour = inside.colour();
  shaft.score = shaft.fill * line.support;
  return true;
}

const std::vector<Shaft>& ShaftFinder::find(const GreyMap& map, const image::FieldOfView& view,
                                            const GreyLevels& levels) {
  const double threshold = levels.threshold;
  const Scene scene{map, view, threshold, std::max(kLeastContrast, kContrast * levels.usual),
                    std::max(kLeastContrast, levels.usual)};
  const std::vector<GreyLine>& lines = finder_.find(map, view, threshold);
  candidates_.clear();
  shafts_.clear();
  for (const GreyLine& a : lines) {
    for (const GreyLine& b : lines) {
      Shaft shaft;
      if (&a < &b && pair(scene, a, b, shaft)) candidates_.push_back(shaft);
    }
    Shaft shaft;
    if (single(scene, a, shaft)) candidates_.push_back(shaft);
  }
  order_.resize(candidates_.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::sort(order_.begin(), order_.end(), [this](std::size_t a, std::size_t b) {
    return candidates_[a].score > candidates_[b].score || (candidates_[a].score == candidates_[b].score && a < b);
  });
  for (const std::size_t k : order_) {
    const Shaft& s = candidates_[k];
    if (static_cast<int>(shafts_.size()) == kMost) break;
    const bool free =
        std::none_of(shafts_.begin(), shafts_.end(), [&](const Shaft& t) { return overlaps(t, s) || overlaps(s, t); });
    if (free) shafts_.push_back(s);
  }
  return shafts_;
}

}  // namespace laparoscope_servo::features
