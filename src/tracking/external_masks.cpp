#include "laparoscope_servo/tracking/external_masks.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "laparoscope_servo/robust/median.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kCells = 320;  // across the reduced masks in which speed is measured

// Speed of a silhouette's border, in widths of the image per second.
constexpr double kUsualSpeed = 0.2;  // assumed where the mask before shows nothing
constexpr double kMostSpeed = 1.0;   // a silhouette that grows faster has appeared instead of moved
constexpr double kReached = 0.95;    // share of the pixels gained that lie no further out than the border moved

constexpr int kGrid = 24;  // points along each side of a region

}  // namespace

void ExternalMasks::add(const cv::Mat& mask, double stamp, std::shared_ptr<const void> holder) {
  const Kept& newest = recent(0);
  if (!newest.mask.empty() && !(stamp > newest.stamp)) clear();
  kept_[next_] = {mask, stamp, std::move(holder)};
  next_ = (next_ + 1) % kept_.size();
}

void ExternalMasks::clear() {
  kept_.fill(Kept());
}

ExternalMask ExternalMasks::at(double stamp, const cv::Size& size) {
  for (std::size_t back = 0; back < kept_.size(); ++back) {
    const Kept& kept = recent(back);
    if (kept.mask.empty()) break;
    const double age = stamp - kept.stamp;
    if (age < 0.0) continue;  // of an image that comes later
    if (!(age <= max_age_) || kept.mask.size() != size) break;
    if (age == 0.0) return {kept.mask, 0.0, 0.0};
    if (cv::countNonZero(kept.mask) == 0) return {kept.mask, age, 0.0};
    const int grown = static_cast<int>(std::ceil(speed(back) * age));
    if (grown == 0) return {kept.mask, age, 0.0};
    cv::dilate(kept.mask, grown_, cv::getStructuringElement(cv::MORPH_RECT, {2 * grown + 1, 2 * grown + 1}));
    return {grown_, age, static_cast<double>(grown)};
  }
  return {};
}

// px per s, of the border of what is covered, outwards: from the mask before to this one.
double ExternalMasks::speed(std::size_t back) {
  const Kept& newer = recent(back);
  const double usual = kUsualSpeed * newer.mask.cols;
  if (back + 1 == kept_.size()) return usual;
  const Kept& older = recent(back + 1);
  if (older.mask.size() != newer.mask.size() || cv::countNonZero(older.mask) == 0) return usual;
  reduce(older.mask, older_);
  reduce(newer.mask, newer_);
  if (cv::countNonZero(older_) == 0) return usual;
  cv::distanceTransform(older_ == 0, distance_, cv::DIST_L2, cv::DIST_MASK_3);
  const double time = newer.stamp - older.stamp;
  const double cell = static_cast<double>(newer.mask.cols) / newer_.cols;
  const double most = kMostSpeed * newer_.cols * time;  // cells
  gained_.clear();
  for (int y = 0; y < newer_.rows; ++y) {
    for (int x = 0; x < newer_.cols; ++x) {
      if (newer_(y, x) != 0 && distance_(y, x) > 0.0f && distance_(y, x) <= most) gained_.push_back(distance_(y, x));
    }
  }
  return gained_.empty() ? 0.0 : robust::nearestRank(gained_, kReached) * cell / time;
}

void ExternalMasks::reduce(const cv::Mat& mask, cv::Mat1b& cells) {
  cv::compare(mask, 0, covered_, cv::CMP_NE);
  const double scale = std::min(1.0, static_cast<double>(kCells) / mask.cols);
  const cv::Size size(std::max(1, static_cast<int>(scale * mask.cols)),
                      std::max(1, static_cast<int>(scale * mask.rows)));
  cv::resize(covered_, cells, size, 0, 0, cv::INTER_AREA);
  cv::threshold(cells, cells, 127, 255, cv::THRESH_BINARY);
}

double coveredShare(const cv::Mat& mask, const geometry::Quadrilateral& corners) {
  if (mask.empty()) return 0.0;
  int covered = 0;
  for (int row = 0; row < kGrid; ++row) {
    const double down = (row + 0.5) / kGrid;
    const Eigen::Vector2d left = (1.0 - down) * corners[0] + down * corners[3];
    const Eigen::Vector2d right = (1.0 - down) * corners[1] + down * corners[2];
    for (int column = 0; column < kGrid; ++column) {
      const double along = (column + 0.5) / kGrid;
      const Eigen::Vector2d p = (1.0 - along) * left + along * right;
      if (!(p.x() >= 0.0 && p.y() >= 0.0 && p.x() <= mask.cols - 1.0 && p.y() <= mask.rows - 1.0)) continue;
      covered += mask.at<uchar>(static_cast<int>(std::lround(p.y())), static_cast<int>(std::lround(p.x()))) != 0;
    }
  }
  return static_cast<double>(covered) / (kGrid * kGrid);
}

}  // namespace laparoscope_servo::tracking
