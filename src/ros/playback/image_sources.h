// The kinds of image sources, for image_source.cpp alone.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ros/playback/image_source.h"

namespace laparoscope_servo {

// Which images of an input are wanted, by SourceOptions. Times in s after the beginning of the input.
class ImageSpan {
 public:
  explicit ImageSpan(const SourceOptions& options) : start_(options.start), end_(options.end) {}

  bool isSkipped(double time) const { return isBefore(time, start_); }
  bool isBehind(double time) const { return !isBefore(time, end_); }

 private:
  // --start 0.2 means frame 5 at 25 Hz, in spite of rounding.
  static bool isBefore(double time, double bound) {
    constexpr double kTolerance = 1e-6;  // s
    return time < bound - kTolerance;
  }

  double start_;
  double end_;
};

// Several bags count as one recording, with messages in the order of time.
std::unique_ptr<ImageSource> openBagSource(const std::vector<std::string>& paths, const SourceOptions& options);
std::unique_ptr<ImageSource> openVideoSource(const std::string& path, const SourceOptions& options);
std::unique_ptr<ImageSource> openFolderSource(const std::string& path, const SourceOptions& options);

}  // namespace laparoscope_servo
