#include "motion/usable_pixels.h"

#include <algorithm>
#include <cmath>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::motion {

namespace {

constexpr int kLeastSide = 4;
constexpr int kMostAlong = 200;  // squares along an image: of 640 px they have 4, of 1920 px 16

LAPAROSCOPE_SERVO_CLONES
void keepLarger(const unsigned char* __restrict from, int count, unsigned char* __restrict to) {
#pragma omp simd
  for (int i = 0; i < count; ++i) to[i] = from[i] > to[i] ? from[i] : to[i];
}

// Each byte becomes the largest of the `count` ones from it on, but for the last ones, which have fewer.
LAPAROSCOPE_SERVO_CLONES
void lookAhead(unsigned char* row, int length, int count) {
  for (int seen = 1; seen < count;) {
    const int further = seen < count - seen ? seen : count - seen;
    seen += further;
#pragma omp simd
    for (int i = 0; i <= length - seen; ++i) row[i] = row[i] > row[i + further] ? row[i] : row[i + further];
  }
}

cv::Size squaresOf(const cv::Size& size, int side) {
  return {(size.width + side - 1) / side, (size.height + side - 1) / side};
}

bool isInside(const geometry::Quadrilateral& region, double x, double y) {
  bool left = true, right = true;
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector2d& a = region[k];
    const Eigen::Vector2d& b = region[(k + 1) % 4];
    const double cross = (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
    left = left && cross >= 0.0;
    right = right && cross <= 0.0;
  }
  return left || right;
}

}  // namespace

int UsablePixels::sideFor(const cv::Size& size) {
  int side = kLeastSide;
  while (size.width > kMostAlong * side) side *= 2;
  return side;
}

// The largest value of any channel in each square.
void UsablePixels::reduce(const cv::Mat& image, cv::Mat1b& brightest) {
  const int bytes = image.cols * image.channels();
  const int step = side_ * image.channels();
  brightest.create(squares_.size());
  row_.assign(static_cast<std::size_t>(brightest.cols) * step, 0);  // longer than the image's where the last is cut off
  for (int j = 0; j < brightest.rows; ++j) {
    const int first = j * side_;
    std::copy_n(image.ptr<unsigned char>(first), bytes, row_.begin());
    for (int v = first + 1; v < std::min(first + side_, image.rows); ++v) {
      keepLarger(image.ptr<unsigned char>(v), bytes, row_.data());
    }
    lookAhead(row_.data(), static_cast<int>(row_.size()), step);
    for (int i = 0; i < brightest.cols; ++i) brightest(j, i) = row_[static_cast<std::size_t>(i) * step];
  }
}

// A square beside one that cannot be used cannot be used either.
void UsablePixels::shrink() {
  squares_.copyTo(before_);
  for (int j = 0; j < squares_.rows; ++j) {
    const int above = std::max(j - 1, 0), below = std::min(j + 1, squares_.rows - 1);
    for (int i = 0; i < squares_.cols; ++i) {
      if (before_(j, i) != 0) continue;
      for (int v = above; v <= below; ++v) {
        for (int u = std::max(i - 1, 0); u <= std::min(i + 1, squares_.cols - 1); ++u) squares_(v, u) = 0;
      }
    }
  }
}

void UsablePixels::look(const cv::Mat& image, const cv::Mat& mask, int saturation, int darkness) {
  side_ = sideFor(image.size());
  squares_.create(squaresOf(image.size(), side_));
  reduce(image, brightest_);
  if (!mask.empty()) reduce(mask, covered_);
  all_ = true;
  for (int j = 0; j < squares_.rows; ++j) {
    for (int i = 0; i < squares_.cols; ++i) {
      const bool lit = brightest_(j, i) > darkness && brightest_(j, i) < saturation;
      squares_(j, i) = lit && (mask.empty() || covered_(j, i) == 0) ? 1 : 0;
      all_ = all_ && squares_(j, i) != 0;
    }
  }
  if (!all_) shrink();
}

JointUse jointlyUsable(const UsablePixels& reference, const UsablePixels& current, const Eigen::Matrix3d& g,
                       const geometry::Quadrilateral* region, Squares& joint) {
  const Squares& here = reference.squares();
  const Squares& there = current.squares();
  joint.create(here.size());
  if (reference.all() && current.all() && region == nullptr) {
    joint.setTo(1);
    return {1.0, reference.side() * reference.side() * static_cast<double>(here.total())};
  }
  const double side = reference.side();
  const double middle = 0.5 * (side - 1.0);
  int within = 0, usable = 0;
  for (int j = 0; j < joint.rows; ++j) {
    for (int i = 0; i < joint.cols; ++i) {
      const double x = i * side + middle, y = j * side + middle;
      joint(j, i) = 0;
      if (region != nullptr && !isInside(*region, x, y)) continue;
      ++within;
      if (here(j, i) == 0) continue;
      const double w = g(2, 0) * x + g(2, 1) * y + g(2, 2);
      const double u = (g(0, 0) * x + g(0, 1) * y + g(0, 2)) / w;
      const double v = (g(1, 0) * x + g(1, 1) * y + g(1, 2)) / w;
      // Squares that lie outside the current image count here; the warp leaves them out.
      const bool shown = w > 0.0 && u >= 0.0 && v >= 0.0 && u < side * there.cols && v < side * there.rows;
      if (shown && there(static_cast<int>(v / side), static_cast<int>(u / side)) == 0) continue;
      joint(j, i) = 1;
      ++usable;
    }
  }
  return {within > 0 ? static_cast<double>(usable) / within : 0.0, side * side * within};
}

}  // namespace laparoscope_servo::motion
