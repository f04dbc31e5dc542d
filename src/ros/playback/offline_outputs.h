// The files that the offline tool writes. Each is created before the work begins, does nothing if its name is empty,
// and gets its name when it is kept; until then an earlier file of that name stays. All throw std::runtime_error with
// the file's name.
#pragma once

#include <laparoscope_servo/TrackedFeatures.h>
#include <ros/time.h>

#include <cstddef>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "ros/common/output_file.h"
#include "ros/tracker/tracker_session.h"

namespace rosbag {
class Bag;
}

namespace laparoscope_servo {

class VideoWriter;

class CsvOutput {
 public:
  explicit CsvOutput(const std::string& name);
  void write(std::size_t frame, const Processed& processed);
  void keep();

 private:
  std::optional<TextFile> file_;
};

class BagOutput {
 public:
  explicit BagOutput(const std::string& name);
  ~BagOutput();
  void write(const ros::Time& record_time, const Processed& processed);
  void write(const ros::Time& record_time, const std::string& topic, const TrackedFeatures& features);
  void keep();

 private:
  std::optional<OutputFile> file_;
  std::unique_ptr<rosbag::Bag> bag_;
};

class OverlayOutput {
 public:
  OverlayOutput(const std::string& name, double rate);
  ~OverlayOutput();
  bool isWanted() const { return file_.has_value(); }
  // 8UC3.
  void write(cv::Mat picture);
  void keep();

 private:
  std::optional<OutputFile> file_;
  double rate_;
  cv::Size size_;
  std::unique_ptr<VideoWriter> writer_;  // created with the first image, which gives the size
};

}  // namespace laparoscope_servo
