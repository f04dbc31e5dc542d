#include "bench/support/contestant.h"

#include <algorithm>
#include <stdexcept>

#include "laparoscope_servo/tracking/region_tracker.h"

namespace laparoscope_servo::bench {

namespace {

class Ours : public Contestant {
 public:
  Ours(std::string name, const tracking::TrackerConfig& config, double period)
      : name_(std::move(name)), tracker_(config), period_(period) {}
  std::string name() const override { return name_; }
  void select(const cv::Mat& image, const geometry::Rectangle& roi) override {
    frame_ = 0;
    tracker_.reset();
    tracker_.select(image, 0.0, roi);
  }
  Verdict track(const cv::Mat& image) override {
    const tracking::TrackResult& result = tracker_.track(image, period_ * ++frame_);
    return {result.g,
            result.state == tracking::State::kTracking,
            false,
            result.visible_fraction,
            result.corner_error,
            result.centre_error,
            result.iterations};
  }

 private:
  std::string name_;
  tracking::RegionTracker tracker_;
  double period_;  // s
  int frame_ = 0;
};

std::unique_ptr<Contestant> oursIn(const char* name, tracking::TrackedChannels channels, double period) {
  tracking::TrackerConfig config;
  config.esm.channels = channels;
  return std::make_unique<Ours>(name, config, period);
}

}  // namespace

std::unique_ptr<Contestant> makeOurs(double period) {
  return std::make_unique<Ours>("ours", tracking::TrackerConfig(), period);
}

std::vector<std::unique_ptr<Contestant>> makeContestants(const std::vector<std::string>& names, double period) {
  std::vector<std::unique_ptr<Contestant>> all;
  all.push_back(makeOurs(period));
#ifdef LAPAROSCOPE_SERVO_BENCH_VISP
  all.push_back(makeVispTuned(3));
  all.push_back(makeVispDefault());
#endif
  all.push_back(makeEcc());
  all.push_back(makeKlt());
  if (names.empty()) return all;
  using tracking::TrackedChannels;
  all.push_back(oursIn("ours_luma", TrackedChannels::kLuma, period));
  all.push_back(oursIn("ours_strongest", TrackedChannels::kStrongest, period));
  all.push_back(oursIn("ours_colour", TrackedChannels::kColour, period));
  std::vector<std::unique_ptr<Contestant>> chosen;
  for (const std::string& name : names) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& c) { return c && c->name() == name; });
    if (found == all.end()) throw std::invalid_argument("no contestant \"" + name + "\" in this build");
    chosen.push_back(std::move(*found));
  }
  return chosen;
}

}  // namespace laparoscope_servo::bench
