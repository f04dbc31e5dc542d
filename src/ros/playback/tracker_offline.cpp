#include "ros/playback/tracker_offline.h"

#include <memory>
#include <optional>
#include <stdexcept>

#include "ros/playback/corners_apart.h"
#include "ros/playback/offline_outputs.h"
#include "ros/playback/offline_run.h"
#include "ros/playback/recorded_results.h"
#include "ros/tracker/overlay.h"
#include "ros/tracker/result_messages.h"
#include "ros/tracker/tracker_session.h"

namespace laparoscope_servo {

namespace {

TrackerParameters withAnyGap(TrackerParameters parameters) {
  parameters.input.max_gap = kAnyGap;
  return parameters;
}

class RegionOffline : public OfflineTracker {
 public:
  explicit RegionOffline(const OfflineOptions& options) : options_(options), session_(withAnyGap(options.parameters)) {
    if (!options.instruments) return;
    instruments_.emplace(*options.instruments);
    session_.setMaskSource(
        [this](const cv::Mat& image, const ros::Time& stamp) { return instruments_->of(image, stamp); });
  }

  void setCameraInfo(const sensor_msgs::CameraInfo& info) override { session_.setCameraInfo(info); }

  void open(double rate) override {
    recorded_ = std::make_unique<RecordedResults>(options_.inputs, options_.source.image_topic);
    csv_.emplace(options_.csv);
    bag_.emplace(options_.bag);
    overlay_.emplace(options_.overlay, rate);
  }

  void take(const SourceImage& image, bool first, OfflineSummary& summary) override {
    const Processed processed = processImage(session_, image);
    if (first && !processed.result.selected_now) throw std::invalid_argument(processed.selection_error);
    if (first && options_.source.resume > 0.0) searchFromNowOn(processed);
    ++summary.by_state[static_cast<std::size_t>(processed.result.state)];
    summary.times.push_back(processed.processing_time);
    compare(image, processed, summary);
    noteCamera(processed);
    csv_->write(image.frame, processed);
    bag_->write(image.record_time, processed);
    if (overlay_->isWanted()) overlay_->write(drawOverlay(processed.image, processed.result, processed.lens.get()));
  }

  std::string note() const override { return camera_note_; }

  void keep() override {
    csv_->keep();
    bag_->keep();
    overlay_->keep();
  }

 private:
  // The region is somewhere else by the next image, as after a loss.
  void searchFromNowOn(const Processed& selected) {
    const auto reference = session_.reference();
    RecallRoute route;
    route.steps.push_back({"", {reference->image, selected.result.roi}, reference->stamp});
    route.epoch = reference->epoch;
    const std::string refused = session_.recall(route);
    if (!refused.empty()) throw std::runtime_error(refused);
  }

  void noteCamera(const Processed& last) {
    camera_note_.clear();
    if (!last.camera) {
      camera_note_ = "without intrinsics there is G, but no H and no task error: " + last.camera_error;
    } else if (session_.ignoresDistortion()) {
      camera_note_ =
          "the lens distortion in camera_info was not corrected, G and H are off by it: see the parameter rectify";
    }
  }

  void compare(const SourceImage& image, const Processed& processed, OfflineSummary& summary) {
    const HomographyConstPtr recorded = recorded_->at(image.header.stamp, image.record_time);
    if (!recorded) return;
    const bool tracks = processed.result.state == tracking::State::kTracking;
    const bool tracked = recorded->state == Homography::TRACKING;
    summary.other_state += tracks != tracked;
    if (!tracks || !tracked) return;
    summary.apart.push_back(cornersApart(recorded->corners, homographyMessage(processed).corners));
  }

  const OfflineOptions& options_;
  std::optional<InstrumentMasks> instruments_;
  TrackerSession session_;
  std::unique_ptr<RecordedResults> recorded_;
  std::optional<CsvOutput> csv_;
  std::optional<BagOutput> bag_;
  std::optional<OverlayOutput> overlay_;
  std::string camera_note_;  // what is missing in the results because of the camera
};

}  // namespace

OfflineSummary trackOffline(const OfflineOptions& options, const OfflineProgress& progress,
                            const OfflineReport& report) {
  if (options.inputs.empty())
    throw std::invalid_argument("no input is given, expected a bag, a video or a folder of images");
  if (!options.parameters.roi) throw std::invalid_argument("no ROI is given, expected x,y,width,height in px");
  RegionOffline tracker(options);
  return runOffline(options, progress, report, tracker);
}

}  // namespace laparoscope_servo
