#include "laparoscope_servo/image/cut_finder.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace laparoscope_servo::image {

namespace {

// Likeness. Of 285 pairs of images of different films 0.19 at most, in the middle 0.00. Between an image and the next
// it was above 0.58 in 99.5 % of seven films; between an image and the half of it and half of another place 0.36 to
// 0.88.
constexpr double kOther = 0.25;  // below it is another place
constexpr double kSteady = 0.5;  // from which on images go on smoothly
constexpr double kWhole = 0.9;   // from which on the later image is no mixture
constexpr double kMixed = 0.9;   // multiple correlation coefficient: what moves between images spoils it a little

constexpr std::size_t kSmooth = 3;  // images on both sides of a cut that go on smoothly
constexpr int kFewestAfter = 4;     // images, at low rates: these, and a mixture in front of them

}  // namespace

CutFinder::CutFinder(double rate) {
  if (!(rate > 0.0) || !std::isfinite(rate))
    throw std::invalid_argument("the rate of the images is " + std::to_string(rate) + " Hz, expected more than 0");
  after_ = static_cast<std::size_t>(std::max<long>(kFewestAfter, std::lround(kAfter * rate)));
}

std::optional<Cut> CutFinder::see(const cv::Mat& image) {
  Sketch sketch = sketchOf(image);
  if (sketch.dark) return miss();
  const double like = seen_.empty() ? 1.0 : likeness(seen_.back().sketch, sketch);
  seen_.push_back({next_, std::move(sketch), like});
  return miss();
}

std::optional<Cut> CutFinder::miss() {
  ++next_;
  return undecided_ + after_ < next_ ? decideNext() : std::nullopt;
}

std::vector<Cut> CutFinder::end() {
  std::vector<Cut> cuts;
  while (undecided_ < next_) {
    if (const std::optional<Cut> cut = decideNext()) cuts.push_back(*cut);
  }
  return cuts;
}

std::optional<Cut> CutFinder::decideNext() {
  const auto due = std::find_if(seen_.begin(), seen_.end(), [this](const Entry& e) { return e.number == undecided_; });
  std::optional<Cut> cut;
  if (due != seen_.end()) cut = decide(static_cast<std::size_t>(due - seen_.begin()));
  ++undecided_;
  while (seen_.size() > kSmooth && seen_[kSmooth].number + after_ < undecided_) seen_.pop_front();
  return cut;
}

// Whether a scene begins with this entry, or behind it, when it is a mixture of two scenes as a change of rate leaves
// it.
std::optional<Cut> CutFinder::decide(std::size_t at) const {
  if (at < kSmooth) return std::nullopt;
  std::size_t first = at;
  double least = kSteady;
  if (seen_[at].likeness >= kOther) {
    if (!mayBeMixture(at)) return std::nullopt;
    first = at + 1;
    least = kWhole;  // a mixture is like both scenes, so that they have to stand out from it
  }
  if (!goesOn(at - kSmooth, least) || !goesOn(first, least) || !isOther(at - 1, first)) return std::nullopt;
  return Cut{seen_[at - 1].number, seen_[first].number};
}

bool CutFinder::mayBeMixture(std::size_t at) const {
  if (at + 1 >= seen_.size()) return false;
  const Entry &between = seen_[at], &after = seen_[at + 1];
  return between.likeness < kWhole && after.likeness >= kOther && after.likeness < kWhole &&
         mixture(seen_[at - 1].sketch, between.sketch, after.sketch) >= kMixed;
}

// Whether the images from this entry on show something, and go on smoothly, each at least so like the one before.
bool CutFinder::goesOn(std::size_t at, double least) const {
  if (at + kSmooth > seen_.size() || !seen_[at].sketch.tells()) return false;
  for (std::size_t next = at + 1; next < at + kSmooth; ++next) {
    if (seen_[next].likeness < least) return false;
  }
  return true;
}

// Nothing from `first` on shows the place that was seen at `last`, nor was the place of `first` seen until then.
bool CutFinder::isOther(std::size_t last, std::size_t first) const {
  const auto near = [this](std::size_t a, std::size_t b) {
    return std::max(seen_[a].number, seen_[b].number) - std::min(seen_[a].number, seen_[b].number) <= after_;
  };
  const auto alike = [this](std::size_t before, std::size_t after) {
    return likeness(seen_[before].sketch, seen_[after].sketch) >= kOther;
  };
  for (std::size_t after = first; after < seen_.size() && near(first, after); ++after) {
    if (alike(last, after) || alike(last - 1, after)) return false;
  }
  for (std::size_t before = 0; before < last; ++before) {
    if (near(last, before) && (alike(before, first) || alike(before, first + 1))) return false;
  }
  return true;
}

}  // namespace laparoscope_servo::image
