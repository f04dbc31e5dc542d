#include "laparoscope_servo/tracking/occlusion_gates.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kGrowSaturated = 2;  // px

LAPAROSCOPE_SERVO_CLONES
void combine(const unsigned char* __restrict bright, const unsigned char* __restrict bright_reference,
             const unsigned char* __restrict valid, int count, unsigned char* __restrict unusable) {
  for (int i = 0; i < count; ++i) unusable[i] = static_cast<unsigned char>(bright[i] | bright_reference[i] | ~valid[i]);
}

LAPAROSCOPE_SERVO_CLONES
void select(const float* __restrict weight, const unsigned char* __restrict unusable, int count, float* __restrict out) {
  for (int i = 0; i < count; ++i) out[i] = unusable[i] == 0 ? weight[i] : 0.0f;
}

}  // namespace

OcclusionGates::OcclusionGates(const OcclusionConfig& config, int saturation)
    : config_(config),
      saturation_(saturation),
      reference_(config.colour, config.bins),
      current_(config.colour, config.bins) {}

void OcclusionGates::setReference(const image::ColourPatch& patch) {
  grid_ = image::AreaGrid(patch.size().width, patch.size().height, config_.rows, config_.columns);
  reference_has_colour_ = patch.has_colour && config_.colour != ColourGate::kNone;
  if (reference_has_colour_) reference_.compute(patch, grid_);
  image::saturatedPixels(patch, saturation_, kGrowSaturated, reference_saturated_);
  reference_saturated_.copyTo(unusable_);
  colour_used_ = reference_has_colour_;
  distances_.assign(grid_.count(), 0.0f);
  colour_rejects_.assign(grid_.count(), 0);
  held_.assign(grid_.count(), 0);
}

void OcclusionGates::observeColour(const image::ColourPatch& patch) {
  image::saturatedPixels(patch, saturation_, kGrowSaturated, saturated_);
  for (int j = 0; j < unusable_.rows; ++j) {
    combine(saturated_.ptr<unsigned char>(j), reference_saturated_.ptr<unsigned char>(j), patch.valid.ptr<unsigned char>(j),
            unusable_.cols, unusable_.ptr<unsigned char>(j));
  }
  colour_used_ = reference_has_colour_ && patch.has_colour;
  if (!colour_used_) {
    std::fill(distances_.begin(), distances_.end(), std::numeric_limits<float>::quiet_NaN());
    std::fill(colour_rejects_.begin(), colour_rejects_.end(), 0);
    return;
  }
  current_.compute(patch, grid_);
  areaDistances(reference_, current_, grid_, config_.bins, distances_);
  for (int area = 0; area < grid_.count(); ++area) {
    colour_rejects_[area] = distances_[area] > static_cast<float>(config_.threshold);  // d > tau_b; false for NaN
  }
}

int OcclusionGates::observeStructure(const image::Patch& image, const image::Patch& reference, const image::Patch& valid,
                                     double gain, double sigma) {
  unsaturated_.resize(grid_.width(), grid_.height());
  for (int j = 0; j < grid_.height(); ++j) {
    select(valid.row(j), unusable_.ptr<unsigned char>(j), grid_.width(), unsaturated_.row(j));
  }
  statistics_.compute(image, reference, unsaturated_, grid_);
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

void OcclusionGates::forget() { std::fill(held_.begin(), held_.end(), 0); }

void OcclusionGates::advance() {
  for (int& images : held_) images = std::max(0, images - 1);
}

const cv::Mat1f& OcclusionGates::weights() {
  weights_.create(grid_.height(), grid_.width());
  row_weights_.resize(grid_.width());
  for (int row = 0; row < grid_.rows(); ++row) {
    for (int i = 0; i < grid_.width(); ++i) {
      row_weights_[i] = occluded(row * grid_.columns() + grid_.columnOf(i)) ? 0.0f : 1.0f;
    }
    for (int j = grid_.rowBegin(row); j < grid_.rowBegin(row + 1); ++j) {
      select(row_weights_.data(), unusable_.ptr<unsigned char>(j), grid_.width(), weights_.ptr<float>(j));
    }
  }
  return weights_;
}

}  // namespace laparoscope_servo::tracking
