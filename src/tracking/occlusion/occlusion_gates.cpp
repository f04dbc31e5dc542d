#include "tracking/occlusion/occlusion_gates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::tracking {

namespace {

// A new illumination estimate is accepted in two cases. Either a share kLeastAgreed of the comparable areas agree under
// the known one, a share kLeastKept of these also agree under the new one,
constexpr double kLeastAgreed = 0.1;
constexpr double kLeastKept = 0.9;
// and the mean distance falls by kLeastBetter;
constexpr double kLeastBetter = 0.01;
// or a share kLeastFound agree under the new one, and these are kManyMore times as many as under the known one.
constexpr double kLeastFound = 0.5;
constexpr double kManyMore = 2.0;

// share of the areas that agreed before, below which the illumination is estimated anew
constexpr double kAsBefore = 0.9;

// Pixels that the histogram of an area needs: the areas of the paper have 14 x 14.
constexpr int kSamples = 14 * 14;

LAPAROSCOPE_SERVO_CLONES
void multiply(const float* __restrict a, const float* __restrict b, int count, float* __restrict product) {
#pragma omp simd
  for (int i = 0; i < count; ++i) product[i] = a[i] * b[i];
}

std::string text(const cv::Size& size) {
  return std::to_string(size.width) + 'x' + std::to_string(size.height);
}

}  // namespace

int samplingStep(const cv::Size& size, const OcclusionConfig& config) {
  const double pixels = static_cast<double>(size.area()) / (config.rows * config.columns);
  return std::max(1, static_cast<int>(std::sqrt(pixels / kSamples)));
}

OcclusionGates::OcclusionGates(const OcclusionConfig& config, int saturation)
    : config_(config),
      highlights_(saturation),
      reference_(config.colour, config.bins),
      current_(config.colour, config.bins) {}

void OcclusionGates::setReference(const image::ColourPatch& patch, const cv::Size& size,
                                  const std::array<bool, 3>& tracked) {
  grid_ = image::AreaGrid(size.width, size.height, config_.rows, config_.columns);
  const int step = samplingStep(size, config_);
  const cv::Size sampled((size.width + step - 1) / step, (size.height + step - 1) / step);
  if (patch.size() != sampled) {
    throw std::invalid_argument("patch of " + text(patch.size()) + " px for a region of " + text(size) +
                                " px, expected every " + std::to_string(step) + ". pixel of it: " + text(sampled) +
                                " px");
  }
  samples_ = image::AreaGrid(patch.size().width, patch.size().height, config_.rows, config_.columns);
  reference_has_colour_ = patch.has_colour && config_.colour != ColourGate::kNone;
  if (reference_has_colour_) {
    reference_.compute(patch, samples_);
    light_change_ = LightChange(patch, config_.bins, samples_);
  }
  highlights_.setReference(patch, size, samples_, step, tracked);
  areas_.resize(size.width);
  colour_used_ = reference_has_colour_;
  distances_.assign(grid_.count(), 0.0f);
  relit_distances_ = distances_;
  colour_rejects_.assign(grid_.count(), 0);
  agree_ = colour_rejects_;
  agreed_before_ = grid_.count();
  held_.assign(grid_.count(), 0);
}

void OcclusionGates::observeColour(const image::ColourPatch& patch) {
  highlights_.observe(patch);
  colour_used_ = reference_has_colour_ && patch.has_colour;
  if (!colour_used_) {
    std::fill(distances_.begin(), distances_.end(), std::numeric_limits<float>::quiet_NaN());
    std::fill(colour_rejects_.begin(), colour_rejects_.end(), 0);
    return;
  }
  light_ = light_change_.known();
  current_.compute(patch, samples_, light_);
  areaDistances(reference_, current_, samples_, config_.bins, distances_);
  if (!rejectByColour() || config_.colour != ColourGate::kNormalised) return;
  accountForLight(patch);
  forgiveClipping(patch);
}

// Returns whether any area is rejected.
bool OcclusionGates::rejectByColour() {
  bool any = false;
  for (int area = 0; area < grid_.count(); ++area) {
    colour_rejects_[area] = distances_[area] > static_cast<float>(config_.threshold);  // d > tau_b; false for NaN
    any |= colour_rejects_[area] != 0;
  }
  return any;
}

// If areas are rejected by colour, the illumination may have changed. A new illumination estimate is accepted only if
// explains() finds that it fits better. Skipped while at least half of all areas agree, and about as many as at the
// last estimate.
void OcclusionGates::accountForLight(const image::ColourPatch& patch) {
  for (int area = 0; area < grid_.count(); ++area) {
    agree_[area] = distances_[area] <= static_cast<float>(config_.threshold);  // false for NaN
  }
  const int agreed = static_cast<int>(std::count(agree_.begin(), agree_.end(), 1));
  const bool most = 2 * agreed >= grid_.count();
  if (most && agreed >= kAsBefore * agreed_before_) {
    agreed_before_ = std::max(agreed_before_, agreed);
    return;
  }
  agreed_before_ = agreed;
  light_change_.look(patch);
  for (const bool all : {false, true}) {
    if (all && most) return;
    const std::optional<ColourLight> light = all ? light_change_.find() : light_change_.follow(agree_);
    if (!light) continue;
    current_.compute(patch, samples_, *light);
    areaDistances(reference_, current_, samples_, config_.bins, relit_distances_);
    if (!explains(relit_distances_, all)) continue;
    light_ = *light;
    distances_.swap(relit_distances_);
    rejectByColour();
    agreed_before_ = static_cast<int>(std::count(colour_rejects_.begin(), colour_rejects_.end(), 0));
    if (2 * agreed_before_ >= grid_.count()) return;
  }
}

// Whether a new illumination estimate, under which the areas have these distances, fits better than the known one. It
// does if the areas that matched before still match (an estimate fitted to an occluder would lose them) and the mean
// distance falls; or, if it was estimated from all areas, when many more match than before.
bool OcclusionGates::explains(const std::vector<float>& distances, bool by_all) const {
  const float threshold = static_cast<float>(config_.threshold);
  int comparable = 0, agreed = 0, kept = 0, agree = 0;
  double better = 0.0;
  for (int area = 0; area < grid_.count(); ++area) {
    if (std::isnan(distances_[area])) continue;
    ++comparable;
    const bool now = distances[area] <= threshold;
    agreed += agree_[area];
    kept += agree_[area] && now;
    agree += now;
    better += std::min(distances_[area], threshold) - std::min(distances[area], threshold);
  }
  if (agreed >= kLeastAgreed * comparable && kept >= kLeastKept * agreed && better > kLeastBetter * comparable)
    return true;
  return by_all && agree >= kLeastFound * comparable && agree >= kManyMore * agreed;
}

// Compares rejected areas again after clipping both histograms at the saturation level of the brighter illumination.
void OcclusionGates::forgiveClipping(const image::ColourPatch& patch) {
  for (int area = 0; area < grid_.count(); ++area) {
    if (!colour_rejects_[area]) continue;
    const float distance = light_change_.clippedDistance(patch, light_, area);
    if (!(distance <= static_cast<float>(config_.threshold))) continue;  // also for NaN: nothing to compare
    colour_rejects_[area] = 0;
    distances_[area] = distance;
  }
}

// Keeps the illumination estimate if most areas that pass the colour gate under it correlate with the reference.
void OcclusionGates::learnLight(double gain, double sigma) {
  int passed = 0, alike = 0;
  for (int area = 0; area < grid_.count(); ++area) {
    const float dissimilarity = statistics_.dissimilarity(area, gain, sigma);
    if (colour_rejects_[area] || std::isnan(dissimilarity)) continue;
    ++passed;
    alike += dissimilarity <= kMaxDissimilarity;
  }
  if (2 * alike > passed) light_change_.learn(light_);
}

void OcclusionGates::report(AreaReport& areas) const {
  areas.rows = grid_.rows();
  areas.columns = grid_.columns();
  areas.distance = distances_;
  areas.occluded.resize(grid_.count());
  areas.cause.resize(grid_.count());
  for (int area = 0; area < grid_.count(); ++area) {
    AreaCause cause = highlights_.hidden(area);
    areas.occluded[area] = occluded(area) || cause == AreaCause::kBorder;
    if (cause == AreaCause::kNone && occluded(area))
      cause = colour_rejects_[area] != 0 ? AreaCause::kColour : AreaCause::kStructure;
    areas.cause[area] = cause;
  }
}

int OcclusionGates::observeStructure(const PatchPair* channels, int count, const image::Patch& valid, double gain,
                                     double sigma) {
  const image::Patch& usable = highlights_.usable();
  unsaturated_.resize(grid_.width(), grid_.height());
  for (int j = 0; j < grid_.height(); ++j) multiply(valid.row(j), usable.row(j), grid_.width(), unsaturated_.row(j));
  statistics_.compute(channels, count, unsaturated_, grid_);
  if (colour_used_) learnLight(gain, sigma);
  if (!config_.structure) return 0;
  int found = 0;
  for (int area = 0; area < grid_.count(); ++area) {
    if (!(statistics_.dissimilarity(area, gain, sigma) > kMaxDissimilarity)) continue;
    if (!occluded(area)) ++found;
    held_[area] = config_.hold + 1;
  }
  return found;
}

double OcclusionGates::lightGain() const {
  if (!colour_used_ || largestDifference(light_, ColourLight()) == 0.0f) return 0.0;
  return (light_[0].gain + light_[1].gain + light_[2].gain) / 3.0;
}

double OcclusionGates::correlation() const {
  double image = 0.0, reference = 0.0, both = 0.0;
  for (int area = 0; area < statistics_.count(); ++area) {
    if (occluded(area)) continue;
    const AreaMoments& m = statistics_.area(area);
    const double pixels = m.share * grid_.pixelsIn(area);
    image += pixels * m.image;
    reference += pixels * m.reference;
    both += pixels * m.both;
  }
  const double product = image * reference;
  return product > 0.0 ? std::clamp(both / std::sqrt(product), -1.0, 1.0) : 0.0;
}

double OcclusionGates::visibleFraction() const {
  double pixels = 0.0;
  for (int area = 0; area < statistics_.count(); ++area) {
    if (!occluded(area)) pixels += statistics_.area(area).share * grid_.pixelsIn(area);
  }
  return pixels / (static_cast<double>(grid_.width()) * grid_.height());
}

void OcclusionGates::forget() {
  std::fill(held_.begin(), held_.end(), 0);
}

void OcclusionGates::advance() {
  for (int& images : held_) images = std::max(0, images - 1);
}

const image::Patch& OcclusionGates::weights() {
  const image::Patch& usable = highlights_.usable();
  weights_.resize(grid_.width(), grid_.height());
  for (int row = 0; row < grid_.rows(); ++row) {
    for (int column = 0; column < grid_.columns(); ++column) {
      const float weight = occluded(row * grid_.columns() + column) ? 0.0f : 1.0f;
      std::fill(areas_.begin() + grid_.columnBegin(column), areas_.begin() + grid_.columnBegin(column + 1), weight);
    }
    for (int j = grid_.rowBegin(row); j < grid_.rowBegin(row + 1); ++j) {
      multiply(areas_.data(), usable.row(j), grid_.width(), weights_.row(j));
    }
  }
  return weights_;
}

}  // namespace laparoscope_servo::tracking
