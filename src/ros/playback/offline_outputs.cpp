#include "ros/playback/offline_outputs.h"

#include <rosbag/bag.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <ostream>
#include <stdexcept>

#include "ros/playback/tracker_csv.h"
#include "ros/playback/video_writer.h"
#include "ros/tracker/result_messages.h"

namespace laparoscope_servo {

CsvOutput::CsvOutput(const std::string& name) {
  if (name.empty()) return;
  file_.emplace(name);
  file_->write(writeCsvHeader);
}

void CsvOutput::write(std::size_t frame, const Processed& processed) {
  if (!file_) return;
  file_->write([&](std::ostream& stream) { writeCsvRow(stream, frame, processed); });
}

void CsvOutput::keep() {
  if (file_) file_->keep();
}

namespace {

[[noreturn]] void failBag(const OutputFile& file, const rosbag::BagException& error) {
  throw std::runtime_error("'" + file.name() + "' cannot be written (" + error.what() + "), is the disk full?");
}

}  // namespace

BagOutput::BagOutput(const std::string& name) {
  if (name.empty()) return;
  file_.emplace(name);
  bag_ = std::make_unique<rosbag::Bag>();
  try {
    bag_->open(file_->path(), rosbag::bagmode::Write);
  } catch (const rosbag::BagException& error) {
    failBag(*file_, error);
  }
}

BagOutput::~BagOutput() {
  if (!bag_) return;
  try {
    bag_->close();
  } catch (const std::exception&) {
    // Its destructor would try again and end the process.
    static_cast<void>(bag_.release());
  }
}

void BagOutput::write(const ros::Time& record_time, const Processed& processed) {
  if (!bag_) return;
  // rosbag does not accept time zero, which the first image of a video has.
  const ros::Time time = std::max(record_time, ros::TIME_MIN);
  try {
    bag_->write("/tracker/homography", time, homographyMessage(processed));
    bag_->write("/tracker/task_error", time, taskErrorMessage(processed));
    bag_->write("/tracker/areas", time, areaSelectionMessage(processed));
    bag_->write("/tracker/roi", time, roiMessage(processed));
  } catch (const rosbag::BagException& error) {
    failBag(*file_, error);
  }
}

void BagOutput::write(const ros::Time& record_time, const std::string& topic, const TrackedFeatures& features) {
  if (!bag_) return;
  try {
    bag_->write(topic, std::max(record_time, ros::TIME_MIN), features);
  } catch (const rosbag::BagException& error) {
    failBag(*file_, error);
  }
}

void BagOutput::keep() {
  if (!bag_) return;
  try {
    bag_->close();
  } catch (const rosbag::BagException& error) {
    failBag(*file_, error);
  }
  file_->keep();
}

OverlayOutput::OverlayOutput(const std::string& name, double rate) : rate_(rate) {
  if (name.empty()) return;
  file_.emplace(name);
  if (!VideoWriter::knows(name)) {
    throw std::runtime_error("'" + name + "' cannot be written as a video, expected a name ending in .mp4 or .avi");
  }
}

OverlayOutput::~OverlayOutput() = default;

void OverlayOutput::write(cv::Mat picture) {
  if (!file_) return;
  if (!writer_) {
    size_ = picture.size();
    writer_ = std::make_unique<VideoWriter>(file_->name(), file_->path(), size_, rate_);
  }
  if (picture.size() != size_) cv::resize(picture, picture, size_);
  writer_->write(picture);
}

void OverlayOutput::keep() {
  if (!writer_) return;
  writer_->close();
  file_->keep();
}

}  // namespace laparoscope_servo
