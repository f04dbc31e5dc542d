#include "features/dot_finder.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "features/dot_outline.h"

namespace laparoscope_servo::features {

namespace {

constexpr double kBand = 2.5;  // px either side of the outline: what blur and the pixel itself make of a step
constexpr double kRing = 5.0;  // px: the background is read from the band's end to here
constexpr double kMinFlatness = 0.35;
constexpr double kMaxFlatnessChange = 0.15;
constexpr double kMinNoise = 1.0;  // grey levels: quantisation, and what is no noise but texture
constexpr double kLooseArea = 1.5;
constexpr int kLeastPixels = 4;

struct Fit {
  int inside = 0, ring = 0;
  double inside_sum = 0.0, ring_sum = 0.0, ring_squares = 0.0;
};

}  // namespace

DotFinder::DotFinder(const DotsConfig& config) : config_(config) {
  const double half = config.range + 3.0 * config.max_radius + kRing + 2.0;
  const std::size_t most = static_cast<std::size_t>((2.0 * half + 3.0) * (2.0 * half + 3.0));
  for (std::vector<float>* values : {&pixels_, &outside_}) values->reserve(most);
  taken_.reserve(most);
  stack_.reserve(most);
}

void DotFinder::open(const cv::Mat& image, const Eigen::Vector2d& about, double half) {
  const int reach = static_cast<int>(std::ceil(half));
  const double u = std::clamp(std::round(about.x()), -1e6, 1e6), v = std::clamp(std::round(about.y()), -1e6, 1e6);
  window_ = cv::Rect(static_cast<int>(u) - reach, static_cast<int>(v) - reach, 2 * reach + 1, 2 * reach + 1) &
            cv::Rect(0, 0, image.cols, image.rows);
  const std::size_t size = static_cast<std::size_t>(std::max(0, window_.area()));
  pixels_.resize(size);
  taken_.assign(size, 0);
  float* to = pixels_.data();
  for (int j = 0; j < window_.height; ++j) {
    const unsigned char* p = image.ptr(window_.y + j) + window_.x * image.channels();
    if (image.channels() == 1) {
      for (int i = 0; i < window_.width; ++i) *to++ = static_cast<float>(p[i]);
    } else {
      for (int i = 0; i < window_.width; ++i, p += 3) {
        *to++ =
            0.114f * static_cast<float>(p[0]) + 0.587f * static_cast<float>(p[1]) + 0.299f * static_cast<float>(p[2]);
      }
    }
  }
}

DotFinder::Blob DotFinder::grow(int u, int v, double threshold, bool bright, int most) {
  Blob blob;
  blob.whole = true;
  int left = u, right = u, top = v, bottom = v;
  double su = 0.0, sv = 0.0, suu = 0.0, suv = 0.0, svv = 0.0;
  stack_.clear();
  const auto take = [&](int i, int j) {
    const std::size_t k = static_cast<std::size_t>(j * window_.width + i);
    if (taken_[k] != 0 || !isInside(i, j, threshold, bright)) return;
    taken_[k] = 1;
    stack_.emplace_back(i, j);
  };
  take(u, v);
  while (!stack_.empty()) {
    const int i = stack_.back().x, j = stack_.back().y;
    stack_.pop_back();
    ++blob.count;
    const double du = i - u, dv = j - v;
    su += du;
    sv += dv;
    suu += du * du;
    suv += du * dv;
    svv += dv * dv;
    left = std::min(left, i);
    right = std::max(right, i);
    top = std::min(top, j);
    bottom = std::max(bottom, j);
    if (i == 0 || j == 0 || i + 1 == window_.width || j + 1 == window_.height) {
      blob.whole = false;
      continue;
    }
    // What is too large is still taken, so that no other place starts in it.
    take(i - 1, j);
    take(i + 1, j);
    take(i, j - 1);
    take(i, j + 1);
  }
  if (blob.count > most) blob.whole = false;
  if (blob.count == 0) return blob;
  const double n = blob.count, mu = su / n, mv = sv / n;
  blob.box = cv::Rect(left, top, right - left + 1, bottom - top + 1);
  blob.centre = Eigen::Vector2d(u + mu, v + mv);
  // A pixel is as wide as it is: its own second moment is 1 / 12.
  blob.spread << suu / n - mu * mu + 1.0 / 12.0, suv / n - mu * mv, suv / n - mu * mv, svv / n - mv * mv + 1.0 / 12.0;
  return blob;
}

bool DotFinder::matches(const Blob& blob, const DotLooks& looks) const {
  if (!blob.whole || blob.count < kLeastPixels) return false;
  // At a threshold that the light has moved out of the middle it is smaller or larger; its weighted area decides later.
  const double change = blob.count / looks.area;
  return change < kLooseArea * (1.0 + config_.max_area_change) &&
         change > 1.0 / (kLooseArea * (1.0 + config_.max_area_change));
}

// An ellipse has the second moments r^2 / 4 along its axes. Around its outline, pixels count by how far their level has
// come from the background's to the dot's; further in they count whole, further out not at all.
bool DotFinder::measure(const Blob& blob, double level, double background, DotMeasurement& result) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(4.0 * blob.spread);
  if (!(axes.eigenvalues()[0] > 1.0)) return false;
  const double minor = std::sqrt(axes.eigenvalues()[0]), major = std::sqrt(axes.eigenvalues()[1]);
  result.looks.flatness = minor / major;
  if (!(minor >= config_.min_radius && major <= config_.max_radius && result.looks.flatness > kMinFlatness))
    return false;
  const Eigen::Matrix2d inverse = (4.0 * blob.spread).inverse();
  const int margin = static_cast<int>(kRing) + 1;
  const cv::Rect box =
      cv::Rect(blob.box.x - margin, blob.box.y - margin, blob.box.width + 2 * margin, blob.box.height + 2 * margin) &
      cv::Rect(0, 0, window_.width, window_.height);
  const DotOutline outline(inverse, minor);
  outside_.resize(static_cast<std::size_t>(box.area()));
  for (int j = 0; j < box.height; ++j)
    outline.distances(box.tl() + cv::Point(0, j), blob.centre, box.width, outside_.data() + j * box.width);
  const float* outside = outside_.data();
  Fit fit;
  for (int j = box.y; j < box.y + box.height; ++j) {
    for (int i = box.x; i < box.x + box.width; ++i) {
      const double d = static_cast<double>(*outside++), value = static_cast<double>(at(i, j));
      if (d < -kBand || (d < -1.0 && minor < kBand + 1.5)) {
        ++fit.inside;
        fit.inside_sum += value;
      } else if (d > kBand && d < kRing) {
        ++fit.ring;
        fit.ring_sum += value;
        fit.ring_squares += value * value;
      }
    }
  }
  if (fit.ring < 12) return false;
  const double low = fit.ring_sum / fit.ring;
  // Of a small dot no pixel is as bright as all of it would be.
  const double high = fit.inside > 0 ? fit.inside_sum / fit.inside : level;
  if (!(std::abs(high - low) >= config_.min_contrast && (high - low) * (level - background) > 0.0)) return false;
  const double ring_sigma = std::sqrt(std::max(0.0, fit.ring_squares / fit.ring - low * low));
  const double noise = std::max(kMinNoise, ring_sigma) / std::abs(high - low);
  double sum = 0.0, su = 0.0, sv = 0.0, nuu = 0.0, nvv = 0.0, nuv = 0.0;
  std::array<double, kSectors> excess{}, length{};
  outside = outside_.data();
  for (int j = box.y; j < box.y + box.height; ++j) {
    for (int i = box.x; i < box.x + box.width; ++i) {
      const double d = static_cast<double>(*outside++);
      if (d > kBand) continue;
      const double du = i - blob.centre.x(), dv = j - blob.centre.y();
      double weight = 1.0;
      if (d > -kBand) {
        weight = (static_cast<double>(at(i, j)) - low) / (high - low);
        nuu += du * du;
        nuv += du * dv;
        nvv += dv * dv;
        const std::size_t sector = static_cast<std::size_t>(sectorOf(du, dv));
        excess[sector] += weight - std::clamp(0.5 - d, 0.0, 1.0);
        length[sector] += 1.0 / (2.0 * kBand);
      }
      sum += weight;
      su += weight * du;
      sv += weight * dv;
    }
  }
  if (!(sum >= kLeastPixels)) return false;
  const Eigen::Vector2d shift(su / sum, sv / sum);
  result.looks.area = sum;
  result.looks.level = high;
  result.looks.background = low;
  result.centre = blob.centre + shift + Eigen::Vector2d(window_.x, window_.y);
  // A common excess is one of size; what differs from part to part is roughness.
  double mean = 0.0, whole = 0.0, squares = 0.0;
  for (int k = 0; k < kSectors; ++k) {
    mean += excess[static_cast<std::size_t>(k)];
    whole += length[static_cast<std::size_t>(k)];
  }
  mean /= std::max(1.0, whole);
  for (int k = 0; k < kSectors; ++k) {
    const double arc = std::max(1.0, length[static_cast<std::size_t>(k)]);
    // The shift of the centre itself shows as one side's excess and the other's lack.
    const double angle = ((k + 0.5) / kSectors - 0.5) * 2.0 * M_PI;
    const double moved = shift.x() * std::cos(angle) + shift.y() * std::sin(angle);
    const double rough = excess[static_cast<std::size_t>(k)] / arc - mean - moved;
    result.roughness = std::max(result.roughness, std::abs(rough));
    // What the noise of the pixels makes of a part is no roughness.
    squares += (rough * rough - noise * noise * 2.0 * kBand / arc) / kSectors;
  }
  const double of_noise = noise * noise / (sum * sum), of_outline = std::max(0.0, squares);
  result.covariance << of_noise * nuu + of_outline, of_noise * nuv, of_noise * nuv, of_noise * nvv + of_outline;
  result.found = true;
  return true;
}

DotMeasurement DotFinder::search(const Eigen::Vector2d& expected, const DotLooks& looks, double threshold) {
  DotMeasurement best;
  const bool bright = looks.level > looks.background;
  const double radius = std::sqrt(looks.area / M_PI);
  std::fill(taken_.begin(), taken_.end(), static_cast<unsigned char>(0));
  const int step = std::max(1, static_cast<int>(0.7 * radius * std::sqrt(looks.flatness)));
  const int u0 = static_cast<int>(std::round(expected.x())) - window_.x;
  const int v0 = static_cast<int>(std::round(expected.y())) - window_.y;
  const int rings = static_cast<int>(std::ceil((config_.range + radius) / step));
  const int most = static_cast<int>(looks.area * kLooseArea * (1.0 + config_.max_area_change)) + 1;
  double nearest = config_.range;
  // Squares of seeds about the place, the nearest first.
  for (int ring = 0; ring <= rings; ++ring) {
    // Whatever starts out there is further away than what was found.
    if (best.found && (ring - 1) * step > nearest + 2.0 * radius) break;
    for (int j = -ring; j <= ring; ++j) {
      const int stride = std::abs(j) == ring || ring == 0 ? 1 : 2 * ring;
      for (int i = -ring; i <= ring; i += stride) {
        const int u = u0 + i * step, v = v0 + j * step;
        if (u < 0 || v < 0 || u >= window_.width || v >= window_.height) continue;
        if (taken_[static_cast<std::size_t>(v * window_.width + u)] != 0 || !isInside(u, v, threshold, bright))
          continue;
        const Blob blob = grow(u, v, threshold, bright, most);
        if (!matches(blob, looks)) continue;
        const double away = (blob.centre + Eigen::Vector2d(window_.x, window_.y) - expected).norm();
        DotMeasurement dot;
        if (!(away <= nearest) || !measure(blob, looks.level, looks.background, dot)) continue;
        if (!(dot.roughness <= config_.max_roughness)) continue;
        const double change = std::max(dot.looks.area / looks.area, looks.area / dot.looks.area);
        if (!(change <= 1.0 + config_.max_area_change)) continue;
        if (!(std::abs(dot.looks.flatness - looks.flatness) <= kMaxFlatnessChange)) continue;
        nearest = away;
        best = dot;
      }
    }
  }
  return best;
}

DotMeasurement DotFinder::find(const cv::Mat& image, const Eigen::Vector2d& expected, const DotLooks& looks) {
  const double radius = std::sqrt(looks.area / M_PI) / std::sqrt(looks.flatness);
  if (!expected.allFinite()) return {};
  open(image, expected, config_.range + 2.0 * radius + kRing);
  if (window_.area() <= 0) return {};
  // Between background and dot; when the light has changed, between what they may have become.
  for (const double gain : {1.0, 0.75, 1.33}) {
    const DotMeasurement dot = search(expected, looks, 0.5 * gain * (looks.level + looks.background));
    if (dot.found) return dot;
  }
  return {};
}

DotMeasurement DotFinder::discover(const cv::Mat& image, const Eigen::Vector2d& point) {
  if (!point.allFinite()) return {};
  open(image, point, 2.0 * config_.max_radius + kRing);
  const int u = static_cast<int>(std::clamp(std::round(point.x()), -1e6, 1e6)) - window_.x;
  const int v = static_cast<int>(std::clamp(std::round(point.y()), -1e6, 1e6)) - window_.y;
  if (window_.area() <= 0 || u < 0 || v < 0 || u >= window_.width || v >= window_.height) return {};
  // Every threshold between this pixel and the others gives a blob; the one with the largest contrast is the dot.
  DotMeasurement best;
  const double here = static_cast<double>(at(u, v));
  for (const bool bright : {true, false}) {
    for (double away = 0.5 * config_.min_contrast; away < 250.0; away += 0.25 * config_.min_contrast) {
      const double threshold = bright ? here - away : here + away;
      if (threshold < 0.0 || threshold > 255.0) break;
      std::fill(taken_.begin(), taken_.end(), static_cast<unsigned char>(0));
      const Blob blob = grow(u, v, threshold, bright, window_.area());
      if (!blob.whole || blob.count < kLeastPixels) continue;
      DotMeasurement dot;
      if (!measure(blob, here, threshold, dot) || !(dot.roughness <= config_.max_roughness)) continue;
      // Around the threshold in the middle the outline is where it belongs.
      const double middle = 0.5 * (dot.looks.level + dot.looks.background);
      if (std::abs(middle - threshold) > 0.25 * std::abs(dot.looks.level - dot.looks.background)) continue;
      const auto contrast = [](const DotMeasurement& m) { return std::abs(m.looks.level - m.looks.background); };
      if (!best.found || contrast(dot) > contrast(best)) best = dot;
    }
  }
  return best;
}

}  // namespace laparoscope_servo::features
