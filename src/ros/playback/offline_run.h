// The way through a file of images that all offline trackers go: each image in turn, what cannot be used is reported.
#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <exception>
#include <stdexcept>
#include <string>

#include "ros/playback/image_source.h"
#include "ros/playback/tracker_offline.h"

namespace laparoscope_servo {

// A tracker with its outputs.
class OfflineTracker {
 public:
  virtual ~OfflineTracker() = default;

  virtual void setCameraInfo(const sensor_msgs::CameraInfo& info) = 0;
  // Creates the outputs; `rate`: Hz, of a video. No output exists before.
  virtual void open(double rate) = 0;
  // Processes one image, which is `first` or not, and writes what there is to write. Adds state and time of the image,
  // and what it compares, to the summary. Throws Unusable when the image cannot be used; any other exception ends the
  // run.
  virtual void take(const SourceImage& image, bool first, OfflineSummary& summary) = 0;
  // What is to be known about the results; empty: nothing.
  virtual std::string note() const { return ""; }
  virtual void keep() = 0;
};

// An image that is left out.
class Unusable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The image that a session takes, message or decoded: process(message, ...) or process(decoded, header, ...).
template <class Session, class... Request>
auto processImage(Session& session, const SourceImage& image, const Request&... request) {
  try {
    if (!image.error.empty()) throw SourceError(image.error);
    return image.message ? session.process(*image.message, request...)
                         : session.process(image.decoded, image.header, request...);
  } catch (const std::exception& error) {
    throw Unusable(error.what());
  }
}

// s: a recording may have long pauses, and its stamps are not checked for single errors
constexpr double kAnyGap = 1e6;

// Throws as trackOffline does.
OfflineSummary runOffline(const OfflineOptions& options, const OfflineProgress& progress, const OfflineReport& report,
                          OfflineTracker& tracker);

}  // namespace laparoscope_servo
