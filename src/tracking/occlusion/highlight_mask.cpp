#include "tracking/occlusion/highlight_mask.h"

#include <algorithm>

#include "laparoscope_servo/image/multiversion.h"

namespace laparoscope_servo::tracking {

namespace {

// px, by which the saturated area is dilated, since a highlight has a bleached rim. If more than kMuch of the region is
// saturated, the cause is the illumination, not a highlight; it is then dilated by kGrowClipped only, the reach of the
// gradient, so that enough pixels remain.
constexpr int kGrowSaturated = 2;
constexpr int kGrowClipped = 1;
constexpr double kMuch = 0.5;  // of the samples
constexpr int kHidden = 2;     // an area is hidden if 1 / kHidden of its samples or more are unusable

LAPAROSCOPE_SERVO_CLONES
void combine(const unsigned char* __restrict bright, const unsigned char* __restrict bright_reference,
             const unsigned char* __restrict valid, int count, float* __restrict usable) {
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    usable[i] = static_cast<float>(static_cast<int>((bright[i] | bright_reference[i] | (valid[i] ^ 255)) == 0));
  }
}

}  // namespace

void HighlightMask::setReference(const image::ColourPatch& patch, const cv::Size& size, const image::AreaGrid& samples,
                                 int step, const std::array<bool, 3>& tracked) {
  for (int c = 0; c < 3; ++c) limits_[c] = tracked[c] ? saturation_ : 256;
  step_ = step;
  samples_ = samples;
  usable_.resize(size.width, size.height);
  row_.resize(samples_.width());
  mark(patch, reference_saturated_);
  reference_saturated_.copyTo(saturated_);
  patch.valid.copyTo(valid_);
  spread();
}

void HighlightMask::hideInReference(const cv::Mat1b& covered) {
  reference_saturated_.setTo(255, covered);
  spread();
}

void HighlightMask::observe(const image::ColourPatch& patch) {
  mark(patch, saturated_);
  patch.valid.copyTo(valid_);
  spread();
}

void HighlightMask::mark(const image::ColourPatch& patch, cv::Mat1b& saturated) const {
  image::saturatedPixels(patch, limits_, (kGrowSaturated + step_ - 1) / step_, saturated);
  if (step_ > 1 || cv::countNonZero(saturated) <= kMuch * static_cast<double>(saturated.total())) return;
  image::saturatedPixels(patch, limits_, kGrowClipped, saturated);
}

// Expands the masks of the samples to all pixels.
void HighlightMask::spread() {
  for (int j = 0; j < samples_.height(); ++j) {
    float* const first = usable_.row(j * step_);
    float* const samples = step_ == 1 ? first : row_.data();
    combine(saturated_.ptr<unsigned char>(j), reference_saturated_.ptr<unsigned char>(j), valid_.ptr<unsigned char>(j),
            samples_.width(), samples);
    if (step_ == 1) continue;
    for (int i = 0; i < samples_.width(); ++i) {
      std::fill(first + i * step_, first + std::min((i + 1) * step_, usable_.width()), samples[i]);
    }
    for (int k = 1; k < step_ && j * step_ + k < usable_.height(); ++k)
      std::copy_n(first, usable_.width(), usable_.row(j * step_ + k));
  }
}

AreaCause HighlightMask::hidden(int area) const {
  const int row = area / samples_.columns(), column = area % samples_.columns();
  const int begin = samples_.columnBegin(column), end = samples_.columnBegin(column + 1);
  int outside = 0, saturated = 0;
  for (int j = samples_.rowBegin(row); j < samples_.rowBegin(row + 1); ++j) {
    const unsigned char* const valid = valid_.ptr<unsigned char>(j);  // 255 or 0, as the other two
    const unsigned char* const here = saturated_.ptr<unsigned char>(j);
    const unsigned char* const in_reference = reference_saturated_.ptr<unsigned char>(j);
    for (int i = begin; i < end; ++i) {
      outside += (valid[i] ^ 255) & 1;
      saturated += valid[i] & (here[i] | in_reference[i]) & 1;
    }
  }
  const int pixels = samples_.pixelsIn(area);
  if (kHidden * (outside + saturated) < pixels || pixels == 0) return AreaCause::kNone;
  return outside > saturated ? AreaCause::kBorder : AreaCause::kHighlight;
}

}  // namespace laparoscope_servo::tracking
