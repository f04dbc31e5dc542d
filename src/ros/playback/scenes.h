// The scenes of an edited film: what lies between its cuts, each with a region that would do.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"
#include "ros/playback/tracker_offline.h"

namespace laparoscope_servo {

struct Scene {
  // s after the beginning of the input, for --start and --end: half an image before the scene, and half an image behind
  // it. Infinite for the end of the last one.
  double start = 0.0;
  double end = std::numeric_limits<double>::infinity();
  std::optional<geometry::Rectangle> roi;  // suggested in the scene's first image; empty: there is none
};

// Reads the whole input, whatever start, end and crop of the options say, up to where it is damaged; see
// image::CutFinder. One scene where there is no cut. Throws as FirstImage does.
std::vector<Scene> findScenes(const OfflineOptions& options);

}  // namespace laparoscope_servo
