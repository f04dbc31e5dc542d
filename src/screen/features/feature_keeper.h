// Keeps the last results of each tracker of features, and finds those of a picture. Not thread-safe.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "screen/features/feature_facts.h"

namespace laparoscope_servo::screen {

class FeatureKeeper {
 public:
  // `now`: s of a steady clock.
  void take(const std::string& tracker, const std::shared_ptr<const FeatureResult>& result, double now);
  void setConnected(const std::string& tracker, bool connected);
  // Which results belong to the picture with this stamp.
  void match(std::int64_t stamp);

  // px, of the newest image of a tracker; empty: not known.
  QSize imageOf(const std::string& tracker) const;
  // By name.
  std::vector<FeatureTrackerFacts> facts() const;

 private:
  struct Kept {
    FeatureTrackerFacts facts;
    std::deque<std::shared_ptr<const FeatureResult>> results;
  };
  void match(Kept& kept) const;

  std::int64_t stamp_ = 0;
  std::map<std::string, Kept> trackers_;
};

}  // namespace laparoscope_servo::screen
