#include "tracking/contour_texture/block_gate.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::tracking {

namespace {

constexpr int kSide = 12;         // px of the level: as few as tell a correlation of 0.6 from chance
constexpr double kTexture = 2.0;  // times the noise

}  // namespace

void BlockGate::setReference(const EsmLevel& reference, const cv::Mat1f& weights, double noise) {
  grid_ = image::AreaGrid(reference.width, reference.height, std::max(1, reference.height / kSide),
                          std::max(1, reference.width / kSide));
  least_variance_ = kTexture * kTexture * noise * noise;
  for (image::Patch* patch : {&of_reference_, &in_image_}) {
    patch->resize(reference.width, reference.height);
    weights.copyTo(patch->view());
  }
  weights_ = weights.clone();
  const std::size_t count = static_cast<std::size_t>(grid_.count());
  verdicts_.assign(count, kSilent);
  covered_.assign(count, false);
  textured_ = correlated_ = 0;
}

void BlockGate::forget() {
  std::fill(covered_.begin(), covered_.end(), false);
  of_reference_.view().copyTo(weights_);
}

// Gives each block a verdict by itself, without its neighbours.
void BlockGate::judge(const EsmLevel& level, double min_correlation) {
  const image::Patch* weight = &of_reference_;
  if (!level.all_valid) {
    cv::multiply(of_reference_.view(), level.valid.view(), in_image_.view());
    weight = &in_image_;
  }
  const PatchPair pair = {&level.planes[0].warped, &level.planes[0].value};
  statistics_.compute(&pair, 1, *weight, grid_);
  textured_ = 0;
  for (int block = 0; block < grid_.count(); ++block) {
    const AreaMoments& moments = statistics_.area(block);
    Verdict& verdict = verdicts_[static_cast<std::size_t>(block)];
    verdict = kSilent;
    if (!(moments.share >= 0.5f) || !(static_cast<double>(moments.reference) > least_variance_)) continue;
    ++textured_;
    const double both = static_cast<double>(moments.both);
    const double scale =
        std::sqrt(static_cast<double>(moments.reference) * std::max(static_cast<double>(moments.image), 1e-6));
    verdict = both > 0.5 * (1.0 + min_correlation) * scale ? kShown
              : both > min_correlation * scale             ? kDoubtful
                                                           : kCovered;
  }
}

// Whether the neighbours of a block are covered: for a block with texture one of them is enough, for a block without it
// takes most of them.
bool BlockGate::coveredAround(int block) const {
  const int row = block / grid_.columns(), column = block % grid_.columns();
  int told = 0, covered = 0;
  for (int j = std::max(0, row - 1); j <= std::min(grid_.rows() - 1, row + 1); ++j) {
    for (int i = std::max(0, column - 1); i <= std::min(grid_.columns() - 1, column + 1); ++i) {
      const Verdict verdict = verdicts_[static_cast<std::size_t>(j * grid_.columns() + i)];
      if (verdict == kSilent) continue;
      ++told;
      covered += verdict == kCovered ? 1 : 0;
    }
  }
  return verdicts_[static_cast<std::size_t>(block)] == kSilent ? 2 * covered > told : covered > 0;
}

int BlockGate::look(const EsmLevel& level, double min_correlation) {
  judge(level, min_correlation);
  int fresh = 0;
  changed_ = false;
  correlated_ = 0;
  for (int block = 0; block < grid_.count(); ++block) {
    const Verdict verdict = verdicts_[static_cast<std::size_t>(block)];
    const bool covered = verdict == kCovered || (verdict != kShown && coveredAround(block));
    if (verdict != kSilent && !covered) ++correlated_;
    char& before = covered_[static_cast<std::size_t>(block)];
    if (covered && !before) ++fresh;
    changed_ = changed_ || covered != static_cast<bool>(before);
    before = covered;
  }
  if (!changed_) return 0;
  of_reference_.view().copyTo(weights_);
  for (int block = 0; block < grid_.count(); ++block) {
    if (!covered_[static_cast<std::size_t>(block)]) continue;
    const int row = block / grid_.columns(), column = block % grid_.columns();
    const cv::Rect box(cv::Point(grid_.columnBegin(column), grid_.rowBegin(row)),
                       cv::Point(grid_.columnBegin(column + 1), grid_.rowBegin(row + 1)));
    weights_(box).setTo(0.0f);
  }
  return fresh;
}

}  // namespace laparoscope_servo::tracking
