#include "ros/playback/tracker_offline.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

#include "ros/playback/corners_apart.h"
#include "ros/playback/offline_outputs.h"
#include "ros/playback/recorded_results.h"
#include "ros/tracker/result_messages.h"
#include "ros/tracker/tracker_session.h"

namespace laparoscope_servo {

namespace {

// s: a recording may have long pauses, and its stamps are not checked for single errors
constexpr double kAnyGap = 1e6;

void refuseToOverwriteInput(const OfflineOptions& options) {
  for (const std::string& output : {options.csv, options.bag, options.overlay}) {
    std::error_code error;
    for (const std::string& input : options.inputs) {
      if (!output.empty() && std::filesystem::equivalent(input, output, error)) {
        throw std::invalid_argument("'" + output + "' is the input, and would be overwritten");
      }
    }
  }
}

Processed process(TrackerSession& session, const SourceImage& image) {
  if (!image.error.empty()) throw SourceError(image.error);
  if (image.message) return session.process(*image.message);
  return session.process(image.decoded, image.header);
}

std::string cameraNote(const TrackerSession& session, const Processed& last) {
  if (!last.camera) return "without intrinsics there is G, but no H and no task error: " + last.camera_error;
  if (!session.ignoresDistortion()) return "";
  return "the lens distortion in camera_info was not corrected, G and H are off by it: see the parameter rectify";
}

TrackerParameters withAnyGap(TrackerParameters parameters) {
  parameters.input.max_gap = kAnyGap;
  return parameters;
}

// All outputs together.
class Outputs {
 public:
  Outputs(const OfflineOptions& options, double rate)
      : csv_(options.csv), bag_(options.bag), overlay_(options.overlay, rate) {}

  void write(const SourceImage& image, const Processed& processed) {
    csv_.write(image.frame, processed);
    bag_.write(image.record_time, processed);
    overlay_.write(processed);
  }
  void keep() {
    csv_.keep();
    bag_.keep();
    overlay_.keep();
  }

 private:
  CsvOutput csv_;
  BagOutput bag_;
  OverlayOutput overlay_;
};

class OfflineRun {
 public:
  OfflineRun(const OfflineOptions& options, const OfflineProgress& progress, const OfflineReport& report)
      : options_(options), progress_(progress), report_(report), session_(withAnyGap(options.parameters)) {
    own_camera_info_ = !options.camera_info.empty();
    if (own_camera_info_) session_.setCameraInfo(readCameraInfo(options.camera_info));
    source_ = openImageSource(options.inputs, options.source);
    recorded_ = std::make_unique<RecordedResults>(options.inputs, options.source.image_topic);
    refuseToOverwriteInput(options);
    outputs_.emplace(options, source_->rate());
    summary_.by_state.assign(4, 0);
  }

  OfflineSummary run() {
    try {
      while (!stopped()) {
        const std::optional<SourceImage> image = source_->next();
        if (!image) break;
        take(*image);
      }
    } catch (const SourceError& error) {
      // The images before are valid, as if the input ended here.
      if (summary_.images == 0) throw;
      summary_.source_error = error.what();
    }
    summary_.notes = source_->notes();
    if (!camera_note_.empty()) summary_.notes.push_back(camera_note_);
    if (summary_.images > 0) {
      outputs_->keep();
    } else if (!summary_.stopped) {
      throw SourceError("'" + options_.inputs.front() + "' has no image after " +
                        std::to_string(options_.source.start) + " s, but " + std::to_string(source_->size()) +
                        " in all");
    }
    return summary_;
  }

 private:
  bool stopped() {
    summary_.stopped = options_.stopped && options_.stopped();
    return summary_.stopped;
  }

  void take(const SourceImage& image) {
    if (image.camera_info && !own_camera_info_) session_.setCameraInfo(*image.camera_info);
    Processed processed;
    try {
      processed = process(session_, image);
    } catch (const std::exception& error) {
      // Without the reference there are no results for later images.
      if (summary_.images == 0) throw std::runtime_error("image " + std::to_string(image.frame) + ": " + error.what());
      summary_.refused += image.lost;
      report_(image.frame, error.what());
      return;
    }
    if (summary_.images == 0 && !processed.result.selected_now) throw std::invalid_argument(processed.selection_error);
    ++summary_.images;
    ++summary_.by_state[static_cast<std::size_t>(processed.result.state)];
    summary_.times.push_back(processed.processing_time);
    compare(image, processed);
    camera_note_ = cameraNote(session_, processed);
    outputs_->write(image, processed);
    progress_(summary_, source_->size());
  }

  void compare(const SourceImage& image, const Processed& processed) {
    const HomographyConstPtr recorded = recorded_->at(image.header.stamp, image.record_time);
    if (!recorded) return;
    const bool tracks = processed.result.state == tracking::State::kTracking;
    const bool tracked = recorded->state == Homography::TRACKING;
    summary_.other_state += tracks != tracked;
    if (!tracks || !tracked) return;
    summary_.apart.push_back(cornersApart(recorded->corners, homographyMessage(processed).corners));
  }

  const OfflineOptions& options_;
  const OfflineProgress& progress_;
  const OfflineReport& report_;
  TrackerSession session_;
  bool own_camera_info_ = false;
  std::unique_ptr<ImageSource> source_;
  std::unique_ptr<RecordedResults> recorded_;
  std::optional<Outputs> outputs_;
  std::string camera_note_;  // what is missing in the results because of the camera
  OfflineSummary summary_;
};

}  // namespace

OfflineSummary trackOffline(const OfflineOptions& options, const OfflineProgress& progress,
                            const OfflineReport& report) {
  if (options.inputs.empty())
    throw std::invalid_argument("no input is given, expected a bag, a video or a folder of images");
  if (!options.parameters.roi) throw std::invalid_argument("no ROI is given, expected x,y,width,height in px");
  return OfflineRun(options, progress, report).run();
}

}  // namespace laparoscope_servo
