#include "ros/playback/feature_offline.h"

#include <memory>
#include <optional>
#include <stdexcept>

#include "ros/common/parameters.h"
#include "ros/features/feature_messages.h"
#include "ros/features/feature_overlay.h"
#include "ros/features/feature_session.h"
#include "ros/features/feature_trackers.h"
#include "ros/playback/feature_csv.h"
#include "ros/playback/offline_options.h"
#include "ros/playback/offline_outputs.h"
#include "ros/playback/offline_run.h"

namespace laparoscope_servo {

namespace {

FeatureSession sessionOf(const FeatureOfflineOptions& options) {
  FeatureInput input;
  std::vector<std::string> errors;
  const std::string name = options.params.empty() ? options.tracker + ".yaml" : options.params;
  auto tracker = makeFeatureTracker(options.tracker, readOfflineTree(options.tracker + ".yaml", options.params), name,
                                    input, errors);
  if (!errors.empty()) throw std::runtime_error(errorReport(errors));
  input.selection.clear();
  input.input.max_gap = kAnyGap;
  return FeatureSession(input, std::move(tracker));
}

class FeatureOffline : public OfflineTracker {
 public:
  explicit FeatureOffline(const FeatureOfflineOptions& options) : options_(options), session_(sessionOf(options)) {
    if (options.selection.empty() ? session_.findsByItself() : session_.takesSelection()) return;
    throw std::invalid_argument(session_.findsByItself()
                                    ? "a selection is given, expected none: " + options.tracker + " finds it by itself"
                                    : "no selection is given, expected --select FILE.yaml with the features");
  }

  void setCameraInfo(const sensor_msgs::CameraInfo& info) override { session_.setCameraInfo(info); }

  void open(double rate) override {
    if (!options_.common.csv.empty()) {
      csv_.emplace(options_.common.csv);
      csv_->write(writeFeatureCsvHeader);
    }
    bag_.emplace(options_.common.bag);
    overlay_.emplace(options_.common.overlay, rate);
  }

  void take(const SourceImage& image, bool first, OfflineSummary& summary) override {
    const bool selects = first && !options_.selection.empty();
    const ProcessedFeatures processed =
        processImage(session_, image, selects ? std::make_optional(options_.selection) : std::nullopt);
    if (selects && !processed.selected_now) throw std::invalid_argument(processed.selection_error);
    ++summary.by_state[static_cast<std::size_t>(processed.result.state)];
    summary.times.push_back(processed.processing_time);
    if (csv_) csv_->write([&](std::ostream& stream) { writeFeatureCsvRows(stream, image.frame, processed); });
    bag_->write(image.record_time, "/" + options_.tracker + "/features",
                featuresMessage(processed.header, processed.image.size(), processed.result, processed.selection_stamp));
    if (overlay_->isWanted()) overlay_->write(drawFeatures(processed.image, processed.result, session_.mask()));
  }

  void keep() override {
    if (csv_) csv_->keep();
    bag_->keep();
    overlay_->keep();
  }

 private:
  const FeatureOfflineOptions& options_;
  FeatureSession session_;
  std::optional<TextFile> csv_;
  std::optional<BagOutput> bag_;
  std::optional<OverlayOutput> overlay_;
};

}  // namespace

OfflineSummary trackFeaturesOffline(const FeatureOfflineOptions& options, const OfflineProgress& progress,
                                    const OfflineReport& report) {
  FeatureOffline tracker(options);
  return runOffline(options.common, progress, report, tracker);
}

}  // namespace laparoscope_servo
