#include "features/shafts/silhouette.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace laparoscope_servo::features {

namespace {

// Wrist and jaws, in widths of the shaft: how far they reach beyond it, and to the side. They open and bend by 45
// degrees.
constexpr double kReach = 3.0;
constexpr double kSpread = 1.0;
constexpr double kAside = 1.5;
constexpr double kTolerance = 1.5;  // cells, of the edges
// Beyond the edges' end nothing but colour holds it together, and tissue that is pale or shines lies next to the jaws:
// what is taken for them has to be greyer, by this share of the threshold.
constexpr double kStrict = 0.6;
// Where the edges lie in the shade the shaft goes on beyond their end: for so many widths what is grey between them
// leads on to wrist and jaws.
constexpr double kCarriedOn = 1.0;
constexpr uchar kHole = 254;  // in cells_: surrounded by it

double beyondEdges(const Shaft& shaft, const Eigen::Vector2d& p) {  // along the axis
  return shaft.axis.dot(p - shaft.entry) - shaft.length;
}

double outsideOf(const Shaft& shaft, const Eigen::Vector2d& p) {
  return std::max(shaft.edges[0].distance(p), shaft.edges[1].distance(p));
}

double halfWidth(const Shaft& shaft, const Eigen::Vector2d& p) {
  return 0.5 * (-shaft.edges[0].distance(p) - shaft.edges[1].distance(p));
}

}  // namespace

bool Silhouette::mayBe(const Shaft& shaft, const Eigen::Vector2d& p) const {
  const double beyond = beyondEdges(shaft, p);
  if (beyond <= 0.0) return outsideOf(shaft, p) <= kTolerance;
  const double width = std::max(2.0 * halfWidth(shaft, shaft.entry + shaft.length * shaft.axis), 3.0);
  const double aside = std::abs(-shaft.axis.y() * (p - shaft.entry).x() + shaft.axis.x() * (p - shaft.entry).y());
  return beyond <= kReach * width && aside <= std::min(0.5 * width + kTolerance + kSpread * beyond, kAside * width);
}

void Silhouette::grow(const GreyMap& map, const image::FieldOfView& view, double threshold, const Shaft& shaft) {
  cells_.create(map.size());
  std::fill_n(cells_.ptr(), cells_.total(), uchar{0});
  stack_.clear();
  count_ = 0;
  const double strict = GreyMap::kZero + kStrict * (threshold - GreyMap::kZero);
  const auto isGrey = [&](int x, int y) {
    if (!map.contains(x, y) || !view.contains(x, y)) return false;
    const Eigen::Vector2d p(x, y);
    const double beyond = beyondEdges(shaft, p);
    const bool between = beyond <= kCarriedOn * shaft.width && outsideOf(shaft, p) <= 0.0;
    return map.colour()(y, x) < (beyond <= 0.0 || between ? threshold : strict);
  };
  const auto add = [&](int x, int y) {
    if (!isGrey(x, y) || cells_(y, x) || !mayBe(shaft, {static_cast<double>(x), static_cast<double>(y)})) return;
    cells_(y, x) = 255;
    stack_.emplace_back(x, y);
    ++count_;
  };
  int inside = 0, grey = 0;
  for (double along = 0.0; along <= shaft.length; along += 1.0) {
    const Eigen::Vector2d p = shaft.entry + along * shaft.axis, side(-shaft.axis.y(), shaft.axis.x());
    const double half = halfWidth(shaft, p);
    for (double across = -half; across <= half; across += 1.0) {
      const Eigen::Vector2d q = p + across * side;
      const cv::Point cell = GreyMap::cellOf(q);
      if (!map.contains(cell.x, cell.y) || !view.contains(cell.x, cell.y)) continue;
      ++inside;
      grey += isGrey(cell.x, cell.y) ? 1 : 0;
      add(cell.x, cell.y);
    }
  }
  fill_ = inside > 0 ? static_cast<double>(grey) / inside : 0.0;
  while (!stack_.empty()) {
    const cv::Point p = stack_.back();
    stack_.pop_back();
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) add(p.x + dx, p.y + dy);
    }
  }
  dropDeadEnds(map, strict, shaft);
  measure(map, threshold, shaft);
  fillHoles();
}

// Beyond the edges' end what is no greyer than pale tissue belongs to it only as far as it leads to what is.
void Silhouette::dropDeadEnds(const GreyMap& map, double strict, const Shaft& shaft) {
  const auto each = [&](const auto& look) {
    for (int y = 0; y < map.rows(); ++y) {
      for (int x = 0; x < map.columns(); ++x) {
        if (!cells_(y, x)) continue;
        const double beyond = beyondEdges(shaft, {static_cast<double>(x), static_cast<double>(y)});
        if (beyond > 0.0) look(cells_(y, x), beyond, map.colour()(y, x) < strict);
      }
    }
  };
  double last = 0.0;
  each([&](uchar&, double beyond, bool is_strict) { last = is_strict ? std::max(last, beyond) : last; });
  each([&](uchar& cell, double beyond, bool is_strict) {
    if (is_strict || beyond <= last) return;
    cell = 0;
    --count_;
  });
}

void Silhouette::measure(const GreyMap& map, double threshold, const Shaft& shaft) {
  double furthest = -1e9;
  box_ = {};
  cv::Point low(map.columns(), map.rows()), high(-1, -1);
  for (int y = 0; y < map.rows(); ++y) {
    for (int x = 0; x < map.columns(); ++x) {
      if (!cells_(y, x)) continue;
      low = {std::min(low.x, x), std::min(low.y, y)};
      high = {std::max(high.x, x), std::max(high.y, y)};
      const Eigen::Vector2d p(x, y);
      const double along = shaft.axis.dot(p - shaft.entry);
      if (along <= furthest) continue;
      furthest = along;
      tip_ = p;
    }
  }
  if (count_ == 0) return;
  box_ = cv::Rect(low, high + cv::Point(1, 1));
  // Half a cell of it lies beyond the last centre; where colour crosses the threshold.
  const Eigen::Vector2d next = tip_ + shaft.axis;
  const cv::Point cell = GreyMap::cellOf(next);
  double share = 0.5;
  if (map.contains(cell.x, cell.y)) {
    const double here = map.colour()(static_cast<int>(tip_.y()), static_cast<int>(tip_.x())),
                 there = map.colour()(cell);
    if (there > here) share = std::clamp((threshold - here) / (there - here), 0.0, 1.0);
  }
  tip_ += share * shaft.axis;
}

// Jaws have windows, which show what lies behind them, and dark or red parts.
void Silhouette::fillHoles() {
  if (count_ == 0) return;
  cv::Mat1b cells = cells_(box_);
  const auto open = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= cells.cols || y >= cells.rows || cells(y, x) != 0) return;
    cells(y, x) = 1;
    stack_.emplace_back(x, y);
  };
  for (int x = 0; x < cells.cols; ++x) open(x, 0), open(x, cells.rows - 1);
  for (int y = 0; y < cells.rows; ++y) open(0, y), open(cells.cols - 1, y);
  while (!stack_.empty()) {
    const cv::Point p = stack_.back();
    stack_.pop_back();
    open(p.x + 1, p.y), open(p.x - 1, p.y), open(p.x, p.y + 1), open(p.x, p.y - 1);
  }
  for (int y = 0; y < cells.rows; ++y) {
    for (int x = 0; x < cells.cols; ++x) {
      uchar& c = cells(y, x);
      c = c == 1 ? 0 : c == 0 ? kHole : c;
    }
  }
}

void Silhouette::draw(const GreyMap& map, double threshold, const Shaft& shaft, double margin, cv::Mat1b& mask) {
  drawn_.create(mask.size());
  std::fill_n(drawn_.ptr(), drawn_.total(), uchar{0});
  // The shaft, from beyond the border to where its edges end.
  std::array<Eigen::Vector2d, 4> corners;
  for (std::size_t k = 0; k < 2; ++k) {
    const GreyLine& e = shaft.edges[k];
    const Eigen::Vector2d along = e.direction() * (e.direction().dot(shaft.axis) < 0.0 ? -1.0 : 1.0);
    const auto at = [&](double s) {
      const double t = (s - shaft.axis.dot(e.point - shaft.entry)) / shaft.axis.dot(along);
      const Eigen::Vector2d cell = e.point + t * along;
      return Eigen::Vector2d(map.toPixel(cell.x()), map.toPixel(cell.y()));
    };
    corners[k == 0 ? 0 : 3] = at(-shaft.width - 10.0);
    corners[k == 0 ? 1 : 2] = at(shaft.length);
  }
  cv::Rect box = drawQuadrangle(corners, drawn_);
  if (count_ > 0) box |= drawGrey(map, threshold);
  growth_.add(drawn_, box, std::clamp(static_cast<int>(std::ceil(margin)), 0, 254), mask);
}

// What else is grey, at the image's resolution: colour between cells, where a cell of it is near.
cv::Rect Silhouette::drawGrey(const GreyMap& map, double threshold) {
  const cv::Rect box =
      cv::Rect(box_.tl() - cv::Point(2, 2), box_.br() + cv::Point(2, 2)) & cv::Rect(cv::Point(0, 0), map.size());
  part_.create(map.size());
  for (int y = 0; y < box.height; ++y) {
    for (int x = 0; x < box.width; ++x) {
      const cv::Point cell = box.tl() + cv::Point(x, y);
      part_(y, x) = cells_(cell) == kHole ? 0 : isNear(cell, box) ? map.colour()(cell) : 255;
    }
  }
  // Between the centres of four cells, whose pixels have weights in steps of half a pixel.
  const int step = map.step(), whole = 2 * step;
  const int limit = static_cast<int>(std::ceil(threshold * whole * whole));
  row_.resize(static_cast<std::size_t>(map.columns()));
  for (int v = 0; v < box.height * step; ++v) {
    const int at = std::clamp(2 * v + 1 - step, 0, (box.height - 1) * whole);
    const int y = at / whole, below = at % whole;
    const uchar *const upper = part_[y], *const lower = part_[std::min(y + 1, box.height - 1)];
    for (int x = 0; x < box.width; ++x) {
      row_[static_cast<std::size_t>(x)] = (whole - below) * upper[x] + below * lower[x];
    }
    drawRow(step, box.width, limit, drawn_[box.y * step + v] + box.x * step);
  }
  return {box.tl() * step, box.size() * step};
}

// From the centre of each cell of row_ to that of the next one; beyond the first and the last one as there.
void Silhouette::drawRow(int step, int cells, int limit, uchar* to) const {
  const int whole = 2 * step, first = step / 2;
  if (whole * row_[0] < limit) std::fill(to, to + first, uchar{255});
  for (int x = 0; x < cells; ++x) {
    const std::size_t left = static_cast<std::size_t>(x),
                      next = std::min(left + 1, static_cast<std::size_t>(cells) - 1);
    const int begin = first + x * step, end = std::min(begin + step, cells * step);
    if (whole * std::min(row_[left], row_[next]) >= limit) continue;
    if (whole * std::max(row_[left], row_[next]) < limit) {
      std::fill(to + begin, to + end, uchar{255});
      continue;
    }
    for (int u = begin; u < end; ++u) {
      const int right = 2 * u + 1 - step - x * whole;
      if ((whole - right) * row_[left] + right * row_[next] < limit) to[u] = 255;
    }
  }
}

bool Silhouette::isNear(const cv::Point& cell, const cv::Rect& box) const {
  for (int y = std::max(cell.y - 1, box.y); y <= std::min(cell.y + 1, box.y + box.height - 1); ++y) {
    for (int x = std::max(cell.x - 1, box.x); x <= std::min(cell.x + 1, box.x + box.width - 1); ++x) {
      if (cells_(y, x) != 0) return true;
    }
  }
  return false;
}

}  // namespace laparoscope_servo::features
