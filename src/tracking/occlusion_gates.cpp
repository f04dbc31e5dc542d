#include "laparoscope_servo/tracking/occlusion_gates.h"

#include <algorithm>
#include <limits>

#include "laparoscope_servo/image/colour_patch.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kGrowSaturated = 2;  // px

}  // namespace

OcclusionGates::OcclusionGates(const OcclusionConfig& config, int saturation)
    : config_(config),
      saturation_(saturation),
      reference_(config.colour, config.bins),
      current_(config.colour, config.bins) {}

void OcclusionGates::setReference(const cv::Mat& patch) {
  grid_ = image::AreaGrid(patch.cols, patch.rows, config_.rows, config_.columns);
  const cv::Mat1b everything(patch.size(), 255);
  reference_has_colour_ = patch.channels() == 3 && config_.colour != ColourGate::kOff;
  if (reference_has_colour_) reference_.compute(patch, everything, grid_);
  image::saturatedPixels(patch, saturation_, kGrowSaturated, reference_saturated_);
  saturated_ = reference_saturated_.clone();
  valid_ = everything.clone();
  colour_used_ = reference_has_colour_;
  distances_.assign(grid_.count(), 0.0f);
  colour_rejects_.assign(grid_.count(), 0);
  held_.assign(grid_.count(), 0);
}

void OcclusionGates::observeColour(const cv::Mat& patch, const cv::Mat1b& valid) {
  valid.copyTo(valid_);
  image::saturatedPixels(patch, saturation_, kGrowSaturated, saturated_);
  colour_used_ = reference_has_colour_ && patch.channels() == 3;
  if (!colour_used_) {
    std::fill(distances_.begin(), distances_.end(), std::numeric_limits<float>::quiet_NaN());
    std::fill(colour_rejects_.begin(), colour_rejects_.end(), 0);
    return;
  }
  current_.compute(patch, valid, grid_);
  areaDistances(reference_, current_, grid_, config_.bins, distances_);
  for (int area = 0; area < grid_.count(); ++area) {
    colour_rejects_[area] = distances_[area] > static_cast<float>(config_.threshold);  // d > tau_b; false for NaN
  }
}

int OcclusionGates::observeStructure(const cv::Mat1f& image, const cv::Mat1f& reference, const cv::Mat1f& valid,
                                     const LightModel& light, double sigma) {
  if (!config_.structure) return 0;
  structureDissimilarity(image, reference, valid, light, sigma, grid_, dissimilarity_);
  int found = 0;
  for (int area = 0; area < grid_.count(); ++area) {
    if (!(dissimilarity_[area] > kMaxDissimilarity)) continue;
    if (!occluded(area)) ++found;
    held_[area] = config_.hold + 1;
  }
  return found;
}

void OcclusionGates::forget() { std::fill(held_.begin(), held_.end(), 0); }

void OcclusionGates::advance() {
  for (int& images : held_) images = std::max(0, images - 1);
}

const cv::Mat1f& OcclusionGates::weights() {
  weights_.create(grid_.height(), grid_.width());
  for (int j = 0; j < grid_.height(); ++j) {
    float* w = weights_.ptr<float>(j);
    const unsigned char* ok = valid_.ptr<unsigned char>(j);
    const unsigned char* bright = saturated_.ptr<unsigned char>(j);
    const unsigned char* bright_reference = reference_saturated_.ptr<unsigned char>(j);
    for (int column = 0; column < grid_.columns(); ++column) {
      const bool out = occluded(grid_.rowOf(j) * grid_.columns() + column);
      for (int i = grid_.columnBegin(column); i < grid_.columnBegin(column + 1); ++i) {
        w[i] = !out && ok[i] != 0 && bright[i] == 0 && bright_reference[i] == 0 ? 1.0f : 0.0f;
      }
    }
  }
  return weights_;
}

}  // namespace laparoscope_servo::tracking
