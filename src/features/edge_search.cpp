#include "laparoscope_servo/features/edge_search.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::features {

namespace {

// The mask along the normal: a derivative of a Gaussian of one sample, which answers a sharp step with its height.
constexpr float kNear = 0.6914f, kFar = 0.3086f;  // k exp(-k^2 / 2), k = 1, 2, over their sum
constexpr int kReach = EdgeProfile::kReach;

// How far behind the straight tangent a curved edge lies, on average over the mask: curvature times half the mean of
// t^2, t being the samples' distances from the normal.
double sag(const EdgeWindow& window, double curvature) {
  double sum = 0.0;
  int samples = 0;
  for (int t = -EdgeProfile::kHalfWidth; t <= EdgeProfile::kHalfWidth; t += window.across_stride, ++samples) {
    sum += t * t;
  }
  return 0.5 * sum / samples * window.step * window.step * curvature;
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

void EdgeSearch::add(const EdgeCandidate& candidate, EdgeCandidates& result) {
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
  result.inside = profile_.read(image, site, window);
  if (!result.inside) return;
  const double bent = sag(window, site.curvature);
  const int last = profile_.count() - kReach;
  const float* p = profile_.levels();
  const auto answer = [p](int k) { return kNear * (p[k + 1] - p[k - 1]) + kFar * (p[k + 2] - p[k - 2]); };
  const float least = static_cast<float>(min_contrast);
  float before = answer(kReach), here = answer(kReach + 1);
  for (int k = kReach + 1; k < last - 1; ++k) {
    const float after = answer(k + 1), left_of_it = before, at_it = here;
    before = here;
    here = after;
    if (!(std::abs(at_it) >= least)) continue;  // most samples lie on no edge
    const float sign = at_it < 0.0f ? -1.0f : 1.0f;
    const float middle = sign * at_it, left = sign * left_of_it, right = sign * after;
    if (!(middle > left && middle >= right)) continue;
    const double samples = static_cast<double>(profile_.first() + k) + static_cast<double>(peak(left, middle, right));
    EdgeCandidate candidate;
    candidate.offset = static_cast<float>(samples * window.step + bent);
    if (!(std::abs(candidate.offset) <= static_cast<float>(window.range))) continue;
    candidate.looks = {sign * middle, p[k - kReach], p[k + kReach]};
    add(candidate, result);
  }
}

}  // namespace laparoscope_servo::features
