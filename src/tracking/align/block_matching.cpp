#include "tracking/align/block_matching.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "laparoscope_servo/image/multiversion.h"
#include "laparoscope_servo/image/warp.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kLargest = 160;   // px of the level, the ROI's larger side: a finer level adds no information
constexpr int kEnough = 12;     // blocks with unique texture, a third of all; with fewer a coarser level is tried
constexpr int kAround = 7;      // px, half the window of the local mean and deviation
constexpr float kFloor = 1.5f;  // grey levels: a smaller deviation is noise
// deviations, at which contrast is clipped so that an edge or a highlight does not dominate
constexpr float kMost = 3.0f;
constexpr double kLeastEnergy = 0.3;  // least mean square contrast of a block with texture
constexpr double kPeak = 0.5;         // least correlation of a confident peak
constexpr double kLead = 0.1;         // least lead over the second peak
// px of the level: peaks further apart are different; blocks whose shifts differ by less moved alike
constexpr double kApart = 2.5;
constexpr int kAlike = 2;  // other blocks that must have moved alike
// share of a block's side: blocks nearer to each other share so many pixels that their agreement proves nothing
constexpr double kIndependent = 0.5;
constexpr double kLeastValid = 0.6;
constexpr double kLeastClear = 0.8;  // share of a block's pixels in the reference that the mask does not cover

struct Products {
  float both = 0.0f;    // dot product of a block with a window
  float energy = 0.0f;  // energy of the window
};

// Adds up column by column, and the columns at the end, since sums across a row would take longer than the products.
LAPAROSCOPE_SERVO_CLONES
Products product(const float* block, int block_stride, const float* window, int stride) {
  constexpr int kSide = BlockMatching::kSide;
  float both[kSide] = {}, energy[kSide] = {};
  for (int j = 0; j < kSide; ++j) {
    const float* __restrict a = block + j * block_stride;
    const float* __restrict b = window + j * stride;
#pragma omp simd
    for (int i = 0; i < kSide; ++i) {
      both[i] += a[i] * b[i];
      energy[i] += b[i] * b[i];
    }
  }
  Products sums;
  for (int i = 0; i < kSide; ++i) {
    sums.both += both[i];
    sums.energy += energy[i];
  }
  return sums;
}

double vertex(double left, double middle, double right) {
  return 0.5 * (left - right) / std::min(left - 2.0 * middle + right, -1e-6);
}

}  // namespace

void BlockMatching::setReference(const image::RegionPyramid& reference, const geometry::Rectangle& roi,
                                 const cv::Mat& mask) {
  int level = 0;
  while (level + 1 < reference.levels() && std::max(roi.width, roi.height) / reference.scale(level) > kLargest) ++level;
  setReference(reference, roi, level, mask);
  const int unique = blocks();
  if (unique >= kEnough || level + 1 >= reference.levels()) return;
  setReference(reference, roi, level + 1, mask);
  if (blocks() <= unique) setReference(reference, roi, level, mask);
}

void BlockMatching::setReference(const image::RegionPyramid& reference, const geometry::Rectangle& roi, int level,
                                 const cv::Mat& mask) {
  level_ = std::min(level, reference.levels() - 1);
  scale_ = reference.scale(level_);
  const cv::Size inner(static_cast<int>(roi.width / scale_), static_cast<int>(roi.height / scale_));
  const cv::Size size(inner.width + 2 * kReach, inner.height + 2 * kReach);
  reference_T_crop_ << scale_, 0.0, roi.x - kReach * scale_, 0.0, scale_, roi.y - kReach * scale_, 0.0, 0.0, 1.0;
  warped_.create(size);
  for (cv::Mat1f* buffer : {&valid_, &in_image_}) buffer->create(size);
  for (cv::Mat1b* buffer : {&covered_.blue, &covered_.valid}) buffer->create(size);
  detail_.create(size);
  column_sums_.assign(3 * static_cast<std::size_t>(size.width), 0.0f);
  blocks_.clear();
  has_room_ = std::min(inner.width, inner.height) >= kSide + kAlong - 1;
  if (std::min(inner.width, inner.height) < kSide) return;
  look(reference, Eigen::Matrix3d::Identity(), mask);
  reference_ = detail_.clone();
  const auto begins = [](int length) {
    std::vector<int> result;
    for (int k = 0; k < kAlong; ++k) result.push_back(kReach + k * (length - kSide) / (kAlong - 1));
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  };
  for (const int top : begins(inner.height)) {
    for (const int left : begins(inner.width)) {
      const cv::Rect box(left, top, kSide, kSide);
      if (!isValid(box.tl(), mask.empty() ? valid_ : in_image_)) continue;
      if (!mask.empty() && cv::mean(valid_(box))[0] < kLeastClear * cv::mean(in_image_(box))[0]) continue;
      const double norm = cv::norm(reference_(box));
      if (norm * norm < kLeastEnergy * box.area()) continue;
      const Peak peak = find(box.tl());
      if (peak.second < peak.top - 2.0 * kLead) blocks_.push_back(box.tl());
    }
  }
  shifts_.reserve(blocks_.size());
}

bool BlockMatching::look(const image::RegionPyramid& current, const Eigen::Matrix3d& g, const cv::Mat& mask) {
  const int l = std::min(level_, current.levels() - 1);
  const bool all =
      lens_ ? image::warpBilinear(current.level(l), g * reference_T_crop_, *lens_,
                                  {current.origin(), static_cast<double>(current.scale(l))}, warped_, valid_)
            : image::warpBilinear(current.level(l), current.levelFromImage(l) * g * reference_T_crop_, warped_, valid_);
  if (!mask.empty()) leaveOut(mask, g);
  contrast();
  return all;
}

// What the mask covers is not valid, nor are the pixels beside it: smoothing has mixed some of it into them.
void BlockMatching::leaveOut(const cv::Mat& mask, const Eigen::Matrix3d& g) {
  valid_.copyTo(in_image_);
  const cv::Size size = valid_.size();
  image::warpNearest(mask, g * reference_T_crop_, lens_.get(), size, covered_);
  for (int j = 0; j < size.height; ++j) {
    const uchar* const covered = covered_.blue.ptr<uchar>(j);
    for (int i = 0; i < size.width; ++i) {
      if (covered[i] == 0) continue;
      for (int y = std::max(j - 1, 0); y <= std::min(j + 1, size.height - 1); ++y) {
        for (int x = std::max(i - 1, 0); x <= std::min(i + 1, size.width - 1); ++x) valid_(y, x) = 0.0f;
      }
    }
  }
}

bool BlockMatching::isValid(const cv::Point& block, const cv::Mat1f& valid) {
  return cv::mean(valid(cv::Rect(block.x, block.y, kSide, kSide)))[0] >= kLeastValid;
}

// Local contrast: deviation from the local mean over the local standard deviation; 0 where the image is not valid.
void BlockMatching::contrast() {
  const int width = warped_.cols, height = warped_.rows;
  float* const count = column_sums_.data();
  float* const sum = count + width;
  float* const squares = sum + width;
  std::fill(column_sums_.begin(), column_sums_.end(), 0.0f);
  const auto add = [&](int j, float sign) {
    const float* value = warped_[j];
    const float* valid = valid_[j];
    for (int i = 0; i < width; ++i) {
      const float v = sign * valid[i];
      count[i] += v;
      sum[i] += v * value[i];
      squares[i] += v * value[i] * value[i];
    }
  };
  for (int j = 0; j < std::min(kAround, height); ++j) add(j, 1.0f);
  for (int j = 0; j < height; ++j) {
    if (j + kAround < height) add(j + kAround, 1.0f);
    if (j - kAround > 0) add(j - kAround - 1, -1.0f);
    float n = 0.0f, s = 0.0f, q = 0.0f;
    for (int i = 0; i < std::min(kAround, width); ++i) n += count[i], s += sum[i], q += squares[i];
    for (int i = 0; i < width; ++i) {
      if (i + kAround < width) n += count[i + kAround], s += sum[i + kAround], q += squares[i + kAround];
      if (i - kAround > 0) n -= count[i - kAround - 1], s -= sum[i - kAround - 1], q -= squares[i - kAround - 1];
      const float mean = s / std::max(n, 1.0f);
      const float deviation = std::sqrt(std::max(q / std::max(n, 1.0f) - mean * mean, kFloor * kFloor));
      detail_(j, i) = valid_(j, i) * std::clamp((warped_(j, i) - mean) / deviation, -kMost, kMost);
    }
  }
}

BlockMatching::Peak BlockMatching::find(const cv::Point& block) {
  constexpr int kPlaces = 2 * kReach + 1;
  std::array<std::array<float, kPlaces>, kPlaces> score;
  const float* const own = reference_.ptr<float>(block.y) + block.x;
  const int stride = static_cast<int>(reference_.step1());
  const float energy = product(own, stride, own, stride).energy;
  for (auto& row_of_scores : score) row_of_scores.fill(-1.0f);
  const auto at = [&](int j, int i) {
    if (score[j][i] > -1.0f) return score[j][i];
    const float* window = detail_.ptr<float>(block.y + j - kReach) + block.x + i - kReach;
    const Products found = product(own, stride, window, static_cast<int>(detail_.step1()));
    return score[j][i] = found.both / std::sqrt(energy * std::max(found.energy, 0.2f * energy) + 1e-6f);
  };
  // Tries every second place, then climbs to the peak: local contrast is smooth over two pixels.
  Peak peak{0.0, 0.0, -1.0, -1.0};
  int row = 0, column = 0;
  const auto better = [&](int j, int i) {
    if (!(at(j, i) > peak.top)) return false;
    peak.top = score[j][i];
    row = j;
    column = i;
    return true;
  };
  for (int j = 0; j < kPlaces; j += 2) {
    for (int i = 0; i < kPlaces; i += 2) better(j, i);
  }
  for (bool climbs = true; climbs;) {
    climbs = false;
    const int j0 = row, i0 = column;
    for (int j = std::max(j0 - 1, 0); j <= std::min(j0 + 1, kPlaces - 1); ++j) {
      for (int i = std::max(i0 - 1, 0); i <= std::min(i0 + 1, kPlaces - 1); ++i) climbs |= better(j, i);
    }
  }
  for (int j = 0; j < kPlaces; ++j) {
    for (int i = 0; i < kPlaces; ++i) {
      if (std::hypot(j - row, i - column) > kApart)
        peak.second = std::max(peak.second, static_cast<double>(score[j][i]));
    }
  }
  if (row == 0 || column == 0 || row == kPlaces - 1 || column == kPlaces - 1) {
    peak.second = peak.top;  // at the border of the range: the correlation may be higher beyond
    return peak;
  }
  peak.x = column - kReach + vertex(score[row][column - 1], score[row][column], score[row][column + 1]);
  peak.y = row - kReach + vertex(score[row - 1][column], score[row][column], score[row + 1][column]);
  return peak;
}

Eigen::Vector2d BlockMatching::centreOf(const cv::Point& block) const {
  return geometry::apply(reference_T_crop_, Eigen::Vector2d(block.x + 0.5 * (kSide - 1), block.y + 0.5 * (kSide - 1)));
}

const std::vector<BlockShift>& BlockMatching::measure(const image::RegionPyramid& current, const Eigen::Matrix3d& g,
                                                      const cv::Mat& mask) {
  shifts_.clear();
  if (blocks_.empty()) return shifts_;
  const bool all_in_image = look(current, g, mask);
  const cv::Mat1f& in_image = mask.empty() ? valid_ : in_image_;
  for (const cv::Point& block : blocks_) {
    if (!all_in_image && !isValid(block, in_image)) continue;
    BlockShift& found = shifts_.emplace_back();
    found.centre = centreOf(block);
    if (!mask.empty() && !isValid(block, valid_)) continue;
    const Peak peak = find(block);
    found.shift = scale_ * Eigen::Vector2d(peak.x, peak.y);
    found.correlation = peak.top;
    found.confident = peak.top >= kPeak && peak.top - peak.second >= kLead;
  }
  std::array<bool, kMostBlocks> alone{};
  for (std::size_t k = 0; k < shifts_.size(); ++k) {
    int alike = 0;
    for (std::size_t other = 0; other < shifts_.size(); ++other) {
      const Eigen::Vector2d apart = (shifts_[other].centre - shifts_[k].centre).cwiseAbs();
      if (shifts_[other].confident && apart.maxCoeff() >= kIndependent * side() &&
          (shifts_[other].shift - shifts_[k].shift).norm() < kApart * scale_)
        ++alike;
    }
    alone[k] = alike < kAlike;
  }
  for (std::size_t k = 0; k < shifts_.size(); ++k) shifts_[k].confident = shifts_[k].confident && !alone[k];
  return shifts_;
}

}  // namespace laparoscope_servo::tracking
