// The kinds of image sources, for image_source.cpp alone.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ros/playback/image_source.h"

namespace laparoscope_servo {

// --start 0.2 means frame 5 at 25 Hz, in spite of rounding.
inline bool isBeforeStart(double time, double start) {
  constexpr double kTolerance = 1e-6;  // s
  return time < start - kTolerance;
}

// Several bags count as one recording, with messages in the order of time.
std::unique_ptr<ImageSource> openBagSource(const std::vector<std::string>& paths, const SourceOptions& options);
std::unique_ptr<ImageSource> openVideoSource(const std::string& path, const SourceOptions& options);
std::unique_ptr<ImageSource> openFolderSource(const std::string& path, const SourceOptions& options);

}  // namespace laparoscope_servo
