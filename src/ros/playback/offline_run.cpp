#include "ros/playback/offline_run.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

#include "ros/tracker/camera_info.h"

namespace laparoscope_servo {

namespace {

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

class OfflineRun {
 public:
  OfflineRun(const OfflineOptions& options, const OfflineProgress& progress, const OfflineReport& report,
             OfflineTracker& tracker)
      : options_(options), progress_(progress), report_(report), tracker_(tracker) {
    own_camera_info_ = !options.camera_info.empty();
    if (own_camera_info_) tracker_.setCameraInfo(readCameraInfo(options.camera_info));
    source_ = openImageSource(options.inputs, options.source);
    refuseToOverwriteInput(options);
    tracker_.open(source_->rate());
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
    if (summary_.images > 0) {
      if (!tracker_.note().empty()) summary_.notes.push_back(tracker_.note());
      tracker_.keep();
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
    if (image.camera_info && !own_camera_info_) tracker_.setCameraInfo(*image.camera_info);
    try {
      tracker_.take(image, summary_.images == 0, summary_);
    } catch (const Unusable& error) {
      // Without the reference there are no results for later images.
      if (summary_.images == 0) throw std::runtime_error("image " + std::to_string(image.frame) + ": " + error.what());
      summary_.refused += image.lost;
      report_(image.frame, error.what());
      return;
    }
    ++summary_.images;
    progress_(summary_, source_->size());
  }

  const OfflineOptions& options_;
  const OfflineProgress& progress_;
  const OfflineReport& report_;
  OfflineTracker& tracker_;
  bool own_camera_info_ = false;
  std::unique_ptr<ImageSource> source_;
  OfflineSummary summary_;
};

}  // namespace

OfflineSummary runOffline(const OfflineOptions& options, const OfflineProgress& progress, const OfflineReport& report,
                          OfflineTracker& tracker) {
  if (options.inputs.empty())
    throw std::invalid_argument("no input is given, expected a bag, a video or a folder of images");
  return OfflineRun(options, progress, report, tracker).run();
}

}  // namespace laparoscope_servo
