// Tracks through a file of images, as fast as it goes, and writes what it found.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "ros/playback/image_source.h"
#include "ros/tracker/tracker_parameters.h"

namespace laparoscope_servo {

struct OfflineOptions {
  std::vector<std::string> inputs;  // see image_source.h
  SourceOptions source;
  TrackerParameters parameters;  // with a ROI
  std::string camera_info;       // file, see readCameraInfo; empty: that of the bag
  // Asked before each image whether to end there, as at the end of the input; empty: never.
  std::function<bool()> stopped;
  // Files to write; empty: none. Each appears under its name when it is whole, and not at all when something could not
  // be written.
  std::string csv;  // see tracker_csv.h
  std::string
      bag;  // Homography, TaskError, AreaSelection, ROI on the nodelet's topics, with the images' headers and times
  std::string overlay;  // video
};

struct OfflineSummary {
  std::size_t images = 0;             // processed
  std::size_t refused = 0;            // not processed, or lost: each was reported
  std::string source_error;           // the input could not be read to its end: why
  bool stopped = false;               // by OfflineOptions::stopped; without an image there are no outputs
  std::vector<std::string> notes;     // of the source, and what the results lack for the camera's sake
  std::vector<std::size_t> by_state;  // images in each state, indexed by tracking::State
  std::vector<double> times;          // s, of the tracker, per image
  std::vector<double> apart;          // px, worst corner, where the tracker tracks now and had when it was recorded
  std::size_t other_state = 0;        // images in which one of the two tracked, and the other did not
};

// Of the images so far.
using OfflineProgress = std::function<void(const OfflineSummary& summary, std::size_t expected)>;
// An image could not be processed and is left out.
using OfflineReport = std::function<void(std::size_t frame, const std::string& error)>;

// Throws std::runtime_error (SourceError for the input) or std::invalid_argument when nothing can be done: input,
// outputs, ROI or parameters are not usable, or the first image is not; and when an output cannot be written on.
OfflineSummary trackOffline(const OfflineOptions& options, const OfflineProgress& progress,
                            const OfflineReport& report);

}  // namespace laparoscope_servo
