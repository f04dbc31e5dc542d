#include "laparoscope_servo/features/edge_memory.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::features {

namespace {

// The means of contrast and levels over all sites, when all has to look as it did: they agree to a share of the larger
// one and some grey levels, but for a gain of the light.
constexpr float kMeanShare = 0.08f;
constexpr float kMeanLevels = 4.0f;
constexpr float kLeastGain = 0.7f;
constexpr double kAlikeShare = 0.7;  // of the sites used

}  // namespace

void EdgeMemory::reset(int slots, int like) {
  like_ = like;
  entries_.assign(static_cast<std::size_t>(slots), Entry());
}

void EdgeMemory::learn(int slot, const EdgeLooks& now, float share) {
  Entry& entry = entries_[static_cast<std::size_t>(slot)];
  if (!entry.known) entry = {now, true};
  entry.looks.contrast += share * (now.contrast - entry.looks.contrast);
  entry.looks.behind += share * (now.behind - entry.looks.behind);
  entry.looks.ahead += share * (now.ahead - entry.looks.ahead);
}

const EdgeLooks* EdgeMemory::find(int slot) const {
  const int slots = static_cast<int>(entries_.size());
  for (int d = 0; d < std::min(slots, like_ + 1); ++d) {
    for (const int s : {slot - d, slot + d}) {
      if (s >= 0 && s < slots && entries_[static_cast<std::size_t>(s)].known) {
        return &entries_[static_cast<std::size_t>(s)].looks;
      }
    }
  }
  return nullptr;
}

void LooksComparison::add(const EdgeLooks& now, const EdgeLooks& before) {
  alike_ += looksAlike(now, before) ? 1 : 0;
  sum(now, now_);
  sum(before, before_);
}

void LooksComparison::sum(const EdgeLooks& looks, EdgeLooks& total) {
  total.contrast += looks.contrast;
  total.behind += looks.behind;
  total.ahead += looks.ahead;
}

bool LooksComparison::isAlike(int used) const {
  const float share = 1.0f / static_cast<float>(used);
  const auto mean = [share](const EdgeLooks& total) {
    return EdgeLooks{share * std::abs(total.contrast), share * total.behind, share * total.ahead};
  };
  const EdgeLooks now = mean(now_), before = mean(before_);
  const float gain = (now.behind + now.ahead) / std::max(1.0f, before.behind + before.ahead);
  const auto near = [gain](float a, float b) {
    return std::abs(a - gain * b) < kMeanShare * std::max(a, gain * b) + kMeanLevels;
  };
  return alike_ >= kAlikeShare * used && gain > kLeastGain && gain < 1.0f / kLeastGain &&
         near(now.contrast, before.contrast) && near(now.behind, before.behind) && near(now.ahead, before.ahead);
}

}  // namespace laparoscope_servo::features
