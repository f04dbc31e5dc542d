#include "laparoscope_servo/ros/tracker_offline.h"

#include <rosbag/bag.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <optional>
#include <stdexcept>

#include "laparoscope_servo/ros/overlay.h"
#include "laparoscope_servo/ros/result_messages.h"
#include "laparoscope_servo/ros/tracker_csv.h"
#include "laparoscope_servo/ros/tracker_session.h"

namespace laparoscope_servo::skin {

namespace {

constexpr double kAnyGap = 1e6;  // s: a recording has its pauses, and no clock that could be wrong for one image

// One of the files to write; does nothing when its path is empty.
class CsvFile {
 public:
  explicit CsvFile(const std::string& path) : path_(path) {
    if (path_.empty()) return;
    errno = 0;
    file_.open(path_, std::ios::trunc);
    if (!file_) throw std::runtime_error("'" + path_ + "' cannot be written: " + std::strerror(errno));
    writeCsvHeader(file_);
  }

  void write(std::size_t frame, const Processed& processed) {
    if (path_.empty()) return;
    writeCsvRow(file_, frame, processed);
    if (!file_) throw std::runtime_error("'" + path_ + "' cannot be written on, is the disk full?");
  }

  void close() {
    if (path_.empty()) return;
    file_.close();
    if (!file_) throw std::runtime_error("'" + path_ + "' cannot be written to its end, is the disk full?");
  }

 private:
  std::string path_;
  std::ofstream file_;
};

class ResultBag {
 public:
  explicit ResultBag(const std::string& path) : path_(path) {
    if (path_.empty()) return;
    try {
      bag_.open(path_, rosbag::bagmode::Write);
    } catch (const rosbag::BagException& error) {
      throw std::runtime_error("'" + path_ + "' cannot be written: " + error.what());
    }
  }

  void write(const ros::Time& record_time, const Processed& processed) {
    if (path_.empty()) return;
    // rosbag takes no time of zero, which the first image of a video has.
    const ros::Time time = std::max(record_time, ros::TIME_MIN);
    bag_.write("/tracker/homography", time, homographyMessage(processed));
    bag_.write("/tracker/task_error", time, taskErrorMessage(processed));
    bag_.write("/tracker/areas", time, areaSelectionMessage(processed));
    bag_.write("/tracker/roi", time, roiMessage(processed));
  }

  void close() {
    if (!path_.empty()) bag_.close();
  }

 private:
  std::string path_;
  rosbag::Bag bag_;
};

class OverlayVideo {
 public:
  OverlayVideo(const std::string& path, double rate) : path_(path), rate_(rate) {
    // The video's size is known with the first image; that the path is wrong should be known before.
    if (path_.empty()) return;
    errno = 0;
    if (!std::ofstream(path_, std::ios::app)) {
      throw std::runtime_error("'" + path_ + "' cannot be written: " + std::strerror(errno));
    }
  }

  void write(const Processed& processed) {
    if (path_.empty()) return;
    cv::Mat picture = drawOverlay(processed.image, processed.result, processed.lens.get());
    if (size_.empty()) open(picture.size());
    if (picture.size() != size_) cv::resize(picture, picture, size_);
    writer_.write(picture);
  }

 private:
  void open(const cv::Size& size) {
    size_ = size;
    const bool avi = std::filesystem::path(path_).extension() == ".avi";
    const int codec = avi ? cv::VideoWriter::fourcc('M', 'J', 'P', 'G') : cv::VideoWriter::fourcc('m', 'p', '4', 'v');
    if (!writer_.open(path_, codec, rate_, size_)) {
      throw std::runtime_error("'" + path_ + "' cannot be written as a video, expected a name ending in .mp4 or .avi");
    }
  }

  std::string path_;
  double rate_;
  cv::Size size_;
  cv::VideoWriter writer_;
};

void refuseToOverwriteInput(const OfflineOptions& options) {
  for (const std::string& output : {options.csv, options.bag, options.overlay}) {
    std::error_code error;
    if (!output.empty() && std::filesystem::equivalent(options.input, output, error)) {
      throw std::invalid_argument("'" + output + "' is the input, and would be overwritten");
    }
  }
}

std::string cameraNote(const TrackerSession& session, const Processed& last) {
  if (!last.camera) return "without intrinsics there is G, but no H and no task error: " + last.camera_error;
  if (!session.ignoresDistortion()) return "";
  return "the lens distortion in camera_info was not corrected, G and H are off by it: see the parameter rectify";
}

Processed process(TrackerSession& session, const SourceImage& image) {
  if (!image.error.empty()) throw SourceError(image.error);
  if (image.message) return session.process(*image.message);
  return session.process(image.decoded, image.header);
}

}  // namespace

OfflineSummary trackOffline(const OfflineOptions& options, const OfflineProgress& progress,
                            const OfflineReport& report) {
  if (!options.parameters.roi) throw std::invalid_argument("no ROI is given, expected x,y,width,height in px");
  TrackerParameters parameters = options.parameters;
  parameters.input.max_gap = kAnyGap;
  TrackerSession session(parameters);
  const bool own_camera_info = !options.camera_info.empty();
  if (own_camera_info) session.setCameraInfo(readCameraInfo(options.camera_info));
  const std::unique_ptr<ImageSource> source = openImageSource(options.input, options.source);
  refuseToOverwriteInput(options);
  CsvFile csv(options.csv);
  ResultBag bag(options.bag);
  OverlayVideo overlay(options.overlay, source->rate());

  OfflineSummary summary;
  summary.by_state.assign(4, 0);
  while (const std::optional<SourceImage> image = source->next()) {
    if (image->camera_info && !own_camera_info) session.setCameraInfo(*image->camera_info);
    Processed processed;
    try {
      processed = process(session, *image);
    } catch (const std::exception& error) {
      const std::string frame = "image " + std::to_string(image->frame) + ": ";
      // Without the reference nothing that follows means anything.
      if (summary.images == 0) throw std::runtime_error(frame + error.what());
      ++summary.refused;
      report(image->frame, error.what());
      continue;
    }
    if (summary.images == 0 && !processed.result.selected_now) throw std::invalid_argument(processed.selection_error);
    ++summary.images;
    ++summary.by_state[static_cast<std::size_t>(processed.result.state)];
    summary.times.push_back(processed.processing_time);
    summary.camera_note = cameraNote(session, processed);
    csv.write(image->frame, processed);
    bag.write(image->record_time, processed);
    overlay.write(processed);
    progress(summary, source->size());
  }
  if (summary.images == 0) {
    throw SourceError("'" + options.input + "' has no image after " + std::to_string(options.source.start) +
                      " s, but " + std::to_string(source->size()) + " in all");
  }
  csv.close();
  bag.close();
  return summary;
}

}  // namespace laparoscope_servo::skin
