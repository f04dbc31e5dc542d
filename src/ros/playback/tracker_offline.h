// Tracks a region through a file of images as fast as possible, and writes the results.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "ros/playback/image_source.h"
#include "ros/playback/instrument_masks.h"
#include "ros/tracker/tracker_parameters.h"

namespace laparoscope_servo {

struct OfflineOptions {
  std::vector<std::string> inputs;  // see image_source.h
  SourceOptions source;
  TrackerParameters parameters;  // of the region tracker; must have a ROI
  // The region tracker is told what instruments cover, which are found in the same images; empty: it is not.
  std::optional<InstrumentMaskOptions> instruments;
  std::string camera_info;  // file, see readCameraInfo; empty: camera_info of the bag
  // Called before each image; true ends the run as at the end of the input; empty: never.
  std::function<bool()> stopped;
  // Files to write; empty: none. Each gets its name when it is complete, and is not kept if an error occurs.
  std::string csv;  // see tracker_csv.h
  std::string
      // Homography, TaskError, AreaSelection, ROI on the nodelet's topics, with the headers and times of the images
      bag;
  std::string overlay;  // video
};

struct OfflineSummary {
  std::size_t images = 0;             // number of images processed
  std::size_t refused = 0;            // number of images not processed, or lost; each was reported
  std::string source_error;           // why the input could not be read to its end
  bool stopped = false;               // ended by OfflineOptions::stopped; without an image there are no outputs
  std::vector<std::string> notes;     // notes of the source, and what is missing in the results because of the camera
  std::vector<std::size_t> by_state;  // images in each state, indexed by tracking::State
  std::vector<double> times;          // s, processing time of the tracker for each image
  std::vector<double> apart;          // px, distance of the worst corner from the recorded one, if both are TRACKING
  std::size_t other_state = 0;        // images that are TRACKING in only one of this run and the recording
};

// Called with the summary of the images so far.
using OfflineProgress = std::function<void(const OfflineSummary& summary, std::size_t expected)>;
// Called if an image could not be processed and is skipped.
using OfflineReport = std::function<void(std::size_t frame, const std::string& error)>;

// Throws std::runtime_error (SourceError for the input) or std::invalid_argument if input, outputs, ROI, parameters or
// the first image cannot be used, or if writing an output fails.
OfflineSummary trackOffline(const OfflineOptions& options, const OfflineProgress& progress,
                            const OfflineReport& report);

}  // namespace laparoscope_servo
