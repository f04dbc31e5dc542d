#include "features/edge_search.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::features {

namespace {

// The mask: along the normal a derivative of a Gaussian of one sample, which answers a sharp step with its height;
// along the tangent the mean of 2 kHalfWidth + 1 samples.
constexpr int kHalfWidth = 2;
constexpr float kNear = 0.6914f, kFar = 0.3086f;  // k exp(-k^2 / 2), k = 1, 2, over their sum
constexpr int kReach = 2;
// How far behind the straight tangent a curved edge lies, on average over the mask: curvature times half the mean of
// t^2.
constexpr double kSag = 1.0;  // (0 + 2 * 1 + 2 * 4) / 5 / 2

struct Grey {
  static float at(const unsigned char* p) { return static_cast<float>(*p); }
  static constexpr int kChannels = 1;
};

struct Luma {
  static float at(const unsigned char* p) {
    return 0.114f * static_cast<float>(p[0]) + 0.587f * static_cast<float>(p[1]) + 0.299f * static_cast<float>(p[2]);
  }
  static constexpr int kChannels = 3;
};

// Adds the samples at (u, v) + k (du, dv), which all lie in the image.
template <class Pixel>
void addSamples(const cv::Mat& image, float u, float v, float du, float dv, int count, float* sums) {
  const std::size_t stride = image.step;
  for (int k = 0; k < count; ++k) {
    const float x = u + static_cast<float>(k) * du, y = v + static_cast<float>(k) * dv;
    const int i = static_cast<int>(x), j = static_cast<int>(y);
    const float a = x - static_cast<float>(i), b = y - static_cast<float>(j);
    const unsigned char* p = image.data + static_cast<std::size_t>(j) * stride + i * Pixel::kChannels;
    const unsigned char* q = p + stride;
    const float above = Pixel::at(p) + a * (Pixel::at(p + Pixel::kChannels) - Pixel::at(p));
    const float below = Pixel::at(q) + a * (Pixel::at(q + Pixel::kChannels) - Pixel::at(q));
    sums[k] += above + b * (below - above);
  }
}

// The k in [low, high] for which low_end <= start + k slope <= high_end.
void clip(double start, double slope, double low_end, double high_end, double& low, double& high) {
  if (std::abs(slope) < 1e-9) {
    if (start < low_end || start > high_end) high = low - 1.0;
    return;
  }
  const double a = (low_end - start) / slope, b = (high_end - start) / slope;
  low = std::max(low, std::min(a, b));
  high = std::min(high, std::max(a, b));
}

float ratio(float a, float b) {
  a = std::abs(a);
  b = std::abs(b);
  return std::min(a, b) / std::max(std::max(a, b), 1e-3f);
}

// The place of the maximum through three equidistant values of which the middle one is the largest: exact for a
// Gaussian, which the answer to a blurred step is.
float peak(float left, float middle, float right) {
  if (left > 0.05f * middle && right > 0.05f * middle) {
    left = std::log(left / middle);
    right = std::log(right / middle);
    middle = 0.0f;
  }
  const float bend = 2.0f * middle - left - right;
  return bend > 0.0f ? std::clamp(0.5f * (right - left) / bend, -0.5f, 0.5f) : 0.0f;
}

}  // namespace

float similarity(const EdgeLooks& a, const EdgeLooks& b, float least) {
  if (!(a.contrast * b.contrast > 0.0f)) return 0.0f;
  const float alike = ratio(a.contrast, b.contrast);
  if (!(alike >= least)) return 0.0f;
  // A change of the light to 0.65 or by 20 grey levels, from one image to the next, is borne.
  const float behind = std::abs(a.behind - b.behind) / (0.35f * std::max(a.behind, b.behind) + 20.0f);
  const float ahead = std::abs(a.ahead - b.ahead) / (0.35f * std::max(a.ahead, b.ahead) + 20.0f);
  const float side = std::min(behind, ahead);
  if (side > 1.0f) return 0.0f;
  return alike / (1.0f + side * side);
}

bool looksAlike(const EdgeLooks& a, const EdgeLooks& b) {
  return a.contrast * b.contrast > 0.0f && ratio(a.contrast, b.contrast) > 0.65f &&
         std::abs(a.behind - b.behind) < 0.15f * std::max(a.behind, b.behind) + 8.0f &&
         std::abs(a.ahead - b.ahead) < 0.15f * std::max(a.ahead, b.ahead) + 8.0f;
}

bool EdgeSearch::readProfile(const cv::Mat& image, const Site& site, const EdgeWindow& window) {
  const double most = std::min(std::ceil(window.range / window.step) + kReach + 1.0, kMostSamples / 2 - 1.0);
  const Eigen::Vector2d along = window.step * site.normal;
  const Eigen::Vector2d across = window.step * Eigen::Vector2d(-site.normal.y(), site.normal.x());
  double low = -most, high = most;
  for (const int t : {-kHalfWidth, kHalfWidth}) {
    const Eigen::Vector2d start = site.point + t * across;
    clip(start.x(), along.x(), 0.0, image.cols - 1.001, low, high);
    clip(start.y(), along.y(), 0.0, image.rows - 1.001, low, high);
  }
  // Single precision may put the last sample a little further out.
  first_ = static_cast<int>(std::ceil(low + 1e-3));
  last_ = static_cast<int>(std::floor(high - 1e-3));
  if (!(first_ <= -kReach - 1 && last_ >= kReach + 1)) return false;
  const int count = last_ - first_ + 1;
  std::fill_n(profile_.begin(), count, 0.0f);
  for (int t = -kHalfWidth; t <= kHalfWidth; ++t) {
    const Eigen::Vector2f start = (site.point + t * across + first_ * along).cast<float>();
    const float du = static_cast<float>(along.x()), dv = static_cast<float>(along.y());
    if (image.channels() == 1) {
      addSamples<Grey>(image, start.x(), start.y(), du, dv, count, profile_.data());
    } else {
      addSamples<Luma>(image, start.x(), start.y(), du, dv, count, profile_.data());
    }
  }
  constexpr float kShare = 1.0f / (2 * kHalfWidth + 1);
  for (int k = 0; k < count; ++k) profile_[static_cast<std::size_t>(k)] *= kShare;
  return true;
}

void EdgeSearch::add(const EdgeCandidate& candidate, EdgeCandidates& result) const {
  if (result.count < EdgeCandidates::kMost) {
    result.at[static_cast<std::size_t>(result.count++)] = candidate;
    return;
  }
  const auto weakest = std::min_element(result.at.begin(), result.at.end(), [](const auto& a, const auto& b) {
    return std::abs(a.looks.contrast) < std::abs(b.looks.contrast);
  });
  if (std::abs(weakest->looks.contrast) < std::abs(candidate.looks.contrast)) *weakest = candidate;
}

void EdgeSearch::find(const cv::Mat& image, const Site& site, const EdgeWindow& window, double min_contrast,
                      EdgeCandidates& result) {
  result.count = 0;
  result.inside = readProfile(image, site, window);
  if (!result.inside) return;
  const int count = last_ - first_ + 1;
  const float* p = profile_.data();
  float* g = answer_.data();
  for (int k = kReach; k < count - kReach; ++k) {
    g[k] = kNear * (p[k + 1] - p[k - 1]) + kFar * (p[k + 2] - p[k - 2]);
  }
  for (int k = kReach + 1; k < count - kReach - 1; ++k) {
    const float sign = g[k] < 0.0f ? -1.0f : 1.0f;
    const float middle = sign * g[k], left = sign * g[k - 1], right = sign * g[k + 1];
    if (!(middle >= min_contrast && middle > left && middle >= right)) continue;
    const double samples = static_cast<double>(first_ + k) + static_cast<double>(peak(left, middle, right));
    EdgeCandidate candidate;
    candidate.offset = static_cast<float>(samples * window.step + kSag * window.step * window.step * site.curvature);
    if (!(std::abs(candidate.offset) <= static_cast<float>(window.range))) continue;
    candidate.looks = {g[k], p[k - kReach], p[k + kReach]};
    add(candidate, result);
  }
}

}  // namespace laparoscope_servo::features
