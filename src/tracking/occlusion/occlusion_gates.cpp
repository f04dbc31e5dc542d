#include "tracking/occlusion/occlusion_gates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kGrowSaturated = 2;  // px

// Pixels of an area that its histogram needs: the paper's areas have as many.
constexpr int kSamples = 14 * 14;

LAPAROSCOPE_SERVO_CLONES
void combine(const unsigned char* __restrict bright, const unsigned char* __restrict bright_reference,
             const unsigned char* __restrict valid, int count, float* __restrict usable) {
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    usable[i] = static_cast<float>(static_cast<int>((bright[i] | bright_reference[i] | (valid[i] ^ 255)) == 0));
  }
}

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
      saturation_(saturation),
      reference_(config.colour, config.bins),
      current_(config.colour, config.bins) {}

void OcclusionGates::setReference(const image::ColourPatch& patch, const cv::Size& size) {
  grid_ = image::AreaGrid(size.width, size.height, config_.rows, config_.columns);
  step_ = samplingStep(size, config_);
  const cv::Size sampled((size.width + step_ - 1) / step_, (size.height + step_ - 1) / step_);
  if (patch.size() != sampled) {
    throw std::invalid_argument("patch of " + text(patch.size()) + " px for a region of " + text(size) +
                                " px, expected every " + std::to_string(step_) + ". pixel of it: " + text(sampled) +
                                " px");
  }
  samples_ = image::AreaGrid(patch.size().width, patch.size().height, config_.rows, config_.columns);
  reference_has_colour_ = patch.has_colour && config_.colour != ColourGate::kNone;
  if (reference_has_colour_) {
    reference_.compute(patch, samples_);
    reference_patch_ = patch.clone();
    light_change_ = LightChange(config_.bins, samples_);
  }
  markSaturated(patch, reference_saturated_);
  usable_.resize(size.width, size.height);
  areas_.resize(size.width);
  spread(reference_saturated_, patch.valid);
  colour_used_ = reference_has_colour_;
  distances_.assign(grid_.count(), 0.0f);
  colour_rejects_.assign(grid_.count(), 0);
  held_.assign(grid_.count(), 0);
}

void OcclusionGates::markSaturated(const image::ColourPatch& patch, cv::Mat1b& mask) const {
  image::saturatedPixels(patch, saturation_, (kGrowSaturated + step_ - 1) / step_, mask);
}

// From the samples to all pixels.
void OcclusionGates::spread(const cv::Mat1b& saturated, const cv::Mat1b& valid) {
  row_.resize(samples_.width());
  for (int j = 0; j < samples_.height(); ++j) {
    float* const first = usable_.row(j * step_);
    float* const samples = step_ == 1 ? first : row_.data();
    combine(saturated.ptr<unsigned char>(j), reference_saturated_.ptr<unsigned char>(j), valid.ptr<unsigned char>(j),
            samples_.width(), samples);
    if (step_ == 1) continue;
    for (int i = 0; i < samples_.width(); ++i) {
      std::fill(first + i * step_, first + std::min((i + 1) * step_, grid_.width()), samples[i]);
    }
    for (int k = 1; k < step_ && j * step_ + k < grid_.height(); ++k)
      std::copy_n(first, grid_.width(), usable_.row(j * step_ + k));
  }
}

void OcclusionGates::observeColour(const image::ColourPatch& patch) {
  markSaturated(patch, saturated_);
  spread(saturated_, patch.valid);
  colour_used_ = reference_has_colour_ && patch.has_colour;
  if (!colour_used_) {
    std::fill(distances_.begin(), distances_.end(), std::numeric_limits<float>::quiet_NaN());
    std::fill(colour_rejects_.begin(), colour_rejects_.end(), 0);
    return;
  }
  current_.compute(patch, samples_);
  areaDistances(reference_, current_, samples_, config_.bins, distances_);
  for (int area = 0; area < grid_.count(); ++area) {
    colour_rejects_[area] = distances_[area] > static_cast<float>(config_.threshold);  // d > tau_b; false for NaN
  }
  if (config_.colour == ColourGate::kNormalised) forgiveClipping(patch);
}

// An area of another colour is compared again as the light that it shows would have clipped the reference, or the
// reference's light it.
void OcclusionGates::forgiveClipping(const image::ColourPatch& patch) {
  for (int area = 0; area < grid_.count(); ++area) {
    if (!colour_rejects_[area]) continue;
    const float distance = light_change_.distance(reference_patch_, patch, area);
    if (!(distance <= static_cast<float>(config_.threshold))) continue;  // also where there is nothing to compare
    colour_rejects_[area] = 0;
    distances_[area] = distance;
  }
}

int OcclusionGates::observeStructure(const PatchPair* channels, int count, const image::Patch& valid, double gain,
                                     double sigma) {
  unsaturated_.resize(grid_.width(), grid_.height());
  for (int j = 0; j < grid_.height(); ++j) multiply(valid.row(j), usable_.row(j), grid_.width(), unsaturated_.row(j));
  statistics_.compute(channels, count, unsaturated_, grid_);
  if (!config_.structure) return 0;
  int found = 0;
  for (int area = 0; area < grid_.count(); ++area) {
    if (!(statistics_.dissimilarity(area, gain, sigma) > kMaxDissimilarity)) continue;
    if (!occluded(area)) ++found;
    held_[area] = config_.hold + 1;
  }
  return found;
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
  weights_.resize(grid_.width(), grid_.height());
  for (int row = 0; row < grid_.rows(); ++row) {
    for (int column = 0; column < grid_.columns(); ++column) {
      const float weight = occluded(row * grid_.columns() + column) ? 0.0f : 1.0f;
      std::fill(areas_.begin() + grid_.columnBegin(column), areas_.begin() + grid_.columnBegin(column + 1), weight);
    }
    for (int j = grid_.rowBegin(row); j < grid_.rowBegin(row + 1); ++j) {
      multiply(areas_.data(), usable_.row(j), grid_.width(), weights_.row(j));
    }
  }
  return weights_;
}

}  // namespace laparoscope_servo::tracking
