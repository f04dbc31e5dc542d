#include "laparoscope_servo/image/sketch.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>

#include "laparoscope_servo/image/field_of_view.h"

namespace laparoscope_servo::image {

namespace {

constexpr int kSide = 128;              // px, the larger side of a sketch
constexpr int kBlock = 16;              // px
constexpr int kMargin = 2;              // px: the border of a round picture is blurred
constexpr double kFine = 1.0;           // px, sigma: noise and compression
constexpr double kCoarse = 8.0;         // px, sigma: light falls off from the centre alike in all scenes
constexpr double kLeastLevel = 1.5;     // grey levels: standard deviation of a block that has structure
constexpr double kDark = 24.0;          // grey levels, mean of the image
constexpr int kFewest = 4;              // blocks with structure
constexpr int kReaches[] = {2, 8, 32};  // px: most images are found within the first
constexpr double kAlike = 0.7;          // correlation coefficient
constexpr double kContrast = 3.0;       // times as much or as little
constexpr double kEnough = 0.6;         // of the blocks: no larger reach is tried
constexpr double kLeastShare = 0.15;    // of a mixture; what is less hides no cut
constexpr int kTogether = 2;            // px, between the motions of neighbours: a turn of 0.1 rad or 10 % of zoom

double deviationOf(const cv::Mat& block) {
  cv::Scalar mean, deviation;
  cv::meanStdDev(block, mean, deviation);
  return deviation[0];
}

cv::Rect blockAt(const cv::Point& corner) {
  return {corner.x, corner.y, kBlock, kBlock};
}

struct Found {
  cv::Point corner;
  cv::Point motion;  // px
};

// Where `after` shows the block within the reach, if it does.
void look(const Sketch& before, const Sketch& after, const cv::Point& corner, int reach, std::vector<Found>& found) {
  const cv::Rect block = blockAt(corner);
  const cv::Rect window = cv::Rect(block.x - reach, block.y - reach, kBlock + 2 * reach, kBlock + 2 * reach) &
                          cv::Rect({0, 0}, after.structure.size());
  cv::Mat scores;
  cv::matchTemplate(after.structure(window), before.structure(block), scores, cv::TM_CCOEFF_NORMED);
  double best = 0.0;
  cv::Point at;
  cv::minMaxLoc(scores, nullptr, &best, nullptr, &at);
  if (!(best >= kAlike)) return;
  const cv::Point place = at + window.tl();
  const double ratio = deviationOf(after.structure(blockAt(place))) / deviationOf(before.structure(block));
  if (!(ratio > 1.0 / kContrast && ratio < kContrast)) return;  // among others, of what has no structure at all
  found.push_back({corner, place - corner});
}

// The blocks with a neighbour that moved alike. Wherever a single one is looked for it is found somewhere, by chance.
std::size_t movedTogether(const std::vector<Found>& found) {
  return static_cast<std::size_t>(std::count_if(found.begin(), found.end(), [&](const Found& a) {
    return std::any_of(found.begin(), found.end(), [&](const Found& b) {
      const cv::Point apart = a.corner - b.corner, differ = a.motion - b.motion;
      return apart != cv::Point() && std::max(std::abs(apart.x), std::abs(apart.y)) <= kBlock &&
             std::max(std::abs(differ.x), std::abs(differ.y)) <= kTogether;
    });
  }));
}

}  // namespace

Sketch sketchOf(const cv::Mat& image) {
  const double scale = static_cast<double>(kSide) / std::max(image.cols, image.rows);
  const cv::Size size(std::max(1, static_cast<int>(std::lround(scale * image.cols))),
                      std::max(1, static_cast<int>(std::lround(scale * image.rows))));
  cv::Mat small;
  cv::resize(image, small, size, 0.0, 0.0, cv::INTER_AREA);
  cv::Mat1b level;
  if (small.channels() == 3) {
    cv::cvtColor(small, level, cv::COLOR_BGR2GRAY);
  } else {
    level = small;
  }
  Sketch sketch;
  sketch.dark = cv::mean(level)[0] < kDark;
  cv::Mat1f fine, coarse;
  level.convertTo(fine, CV_32F);
  cv::GaussianBlur(fine, coarse, cv::Size(), kCoarse);
  cv::GaussianBlur(fine, fine, cv::Size(), kFine);
  sketch.structure = fine - coarse;
  FieldOfView view;
  view.compute(level);
  const auto deep = [&view](int x, int y) { return view.isDeep(x, y, kMargin); };
  for (int y = kMargin; y + kBlock + kMargin <= size.height; y += kBlock) {
    for (int x = kMargin; x + kBlock + kMargin <= size.width; x += kBlock) {
      const int right = x + kBlock - 1, bottom = y + kBlock - 1;
      if (!deep(x, y) || !deep(right, y) || !deep(x, bottom) || !deep(right, bottom)) continue;  // the field is convex
      if (deviationOf(sketch.structure(blockAt({x, y}))) >= kLeastLevel) sketch.corners.emplace_back(x, y);
    }
  }
  return sketch;
}

bool Sketch::tells() const {
  return corners.size() >= static_cast<std::size_t>(kFewest);
}

double likeness(const Sketch& before, const Sketch& after) {
  if (before.structure.size() != after.structure.size()) return 0.0;
  if (!before.tells()) return 1.0;
  double most = 0.0;
  std::vector<Found> found;
  for (const int reach : kReaches) {
    found.clear();
    for (const cv::Point& corner : before.corners) look(before, after, corner, reach, found);
    most = std::max(most, static_cast<double>(movedTogether(found)) / static_cast<double>(before.corners.size()));
    if (most >= kEnough) break;
  }
  return most;
}

double mixture(const Sketch& before, const Sketch& between, const Sketch& after) {
  const cv::Mat1f &a = before.structure, &m = between.structure, &b = after.structure;
  if (a.size() != m.size() || b.size() != m.size()) return 0.0;
  const double aa = a.dot(a), bb = b.dot(b), mm = m.dot(m), ab = a.dot(b), am = a.dot(m), bm = b.dot(m);
  const double determinant = aa * bb - ab * ab;
  if (!(determinant > 1e-6 * aa * bb && mm > 0.0)) return 0.0;
  const double share_a = (bb * am - ab * bm) / determinant, share_b = (aa * bm - ab * am) / determinant;
  if (!(share_a > kLeastShare && share_b > kLeastShare)) return 0.0;
  return std::sqrt(std::clamp((share_a * am + share_b * bm) / mm, 0.0, 1.0));
}

}  // namespace laparoscope_servo::image
