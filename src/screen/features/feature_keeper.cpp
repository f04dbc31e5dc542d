#include "screen/features/feature_keeper.h"

namespace laparoscope_servo::screen {

namespace {

constexpr std::size_t kKept = 64;  // results: one second at 60 Hz, longer than the delay of a preview

}  // namespace

void FeatureKeeper::take(const std::string& tracker, const std::shared_ptr<const FeatureResult>& result, double now) {
  Kept& kept = trackers_[tracker];
  kept.facts.name = tracker;
  kept.facts.heard_at = now;
  kept.facts.newest = result;
  kept.results.push_back(result);
  if (kept.results.size() > kKept) kept.results.pop_front();
  match(kept);
}

void FeatureKeeper::setConnected(const std::string& tracker, bool connected) {
  Kept& kept = trackers_[tracker];
  kept.facts.name = tracker;
  kept.facts.connected = connected;
}

void FeatureKeeper::match(std::int64_t stamp) {
  stamp_ = stamp;
  for (auto& [name, kept] : trackers_) match(kept);
}

// Results of images that the picture has not reached yet, or of before time jumped back, are left out.
void FeatureKeeper::match(Kept& kept) const {
  kept.facts.drawn.reset();
  for (const std::shared_ptr<const FeatureResult>& result : kept.results) {
    if (result->stamp > stamp_) continue;
    if (!kept.facts.drawn || result->stamp >= kept.facts.drawn->stamp) kept.facts.drawn = result;
  }
}

QSize FeatureKeeper::imageOf(const std::string& tracker) const {
  const auto kept = trackers_.find(tracker);
  return kept != trackers_.end() && kept->second.facts.newest ? kept->second.facts.newest->image : QSize();
}

std::vector<FeatureTrackerFacts> FeatureKeeper::facts() const {
  std::vector<FeatureTrackerFacts> facts;
  for (const auto& [name, kept] : trackers_) facts.push_back(kept.facts);
  return facts;
}

}  // namespace laparoscope_servo::screen
