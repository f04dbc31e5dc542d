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
  explicit ImageSpan(const SourceOptions& options)
      : begin_(options.start), resume_(options.resume), end_(options.end) {}

  // Called once for each image, in their order.
  bool isSkipped(double time) {
    if (isBefore(time, begin_)) return true;
    begin_ = resume_;  // for all but the first that is wanted
    return false;
  }
  bool isBehind(double time) const { return !isBefore(time, end_); }

 private:
  // --start 0.2 means frame 5 at 25 Hz, in spite of rounding.
  static bool isBefore(double time, double bound) {
    constexpr double kTolerance = 1e-6;  // s
    return time < bound - kTolerance;
  }

  double begin_;  // of what is wanted next
  double resume_;
  double end_;
};

// Several bags count as one recording, with messages in the order of time.
std::unique_ptr<ImageSource> openBagSource(const std::vector<std::string>& paths, const SourceOptions& options);
std::unique_ptr<ImageSource> openVideoSource(const std::string& path, const SourceOptions& options);
std::unique_ptr<ImageSource> openFolderSource(const std::string& path, const SourceOptions& options);

}  // namespace laparoscope_servo
