// The files of a recording: bags that follow each other, each of which can be replayed without the others.
//
// A file is NAME.bag.active while it is written. One that was cut off keeps that name; what was written until then is
// there again after `rosbag reindex`.
#pragma once

#include <ros/time.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CompressedImage.h>
#include <std_msgs/String.h>
#include <topic_tools/shape_shifter.h>

#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <variant>

#include "ros/recording/recorder_config.h"

namespace laparoscope_servo {

struct Recorded {
  std::string topic;
  ros::Time time;
  boost::shared_ptr<ros::M_string> header;  // of the connection; latched topics begin each file
  std::variant<topic_tools::ShapeShifter::ConstPtr, sensor_msgs::CompressedImageConstPtr, std_msgs::StringConstPtr>
      message;
  std::size_t bytes() const;
  bool isLatched() const;
};

class CaseFile {
 public:
  // Makes the folder. Throws std::runtime_error when it cannot be made.
  explicit CaseFile(const RecorderConfig& config);
  // Closes the file.
  ~CaseFile();
  CaseFile(const CaseFile&) = delete;
  CaseFile& operator=(const CaseFile&) = delete;

  // Why nothing can be written at present; empty when it can be. To be asked once in a while: it looks at the disk.
  const std::string& look();
  // Begins a file when there is none, or the one before is full. Throws std::runtime_error when it cannot be written;
  // the file is closed then.
  void write(const Recorded& recorded);
  void close();

  const std::string& problem() const { return problem_; }
  double freeMegabytes() const { return free_; }
  const std::string& name() const { return name_; }
  std::uint64_t bytes() const { return closed_bytes_ + (bag_ ? bag_->getSize() : 0); }
  int files() const { return files_; }

 private:
  void open(const ros::Time& time);
  bool isFull(const ros::Time& time) const;
  void put(const Recorded& recorded, const ros::Time& time);

  RecorderConfig config_;
  std::unique_ptr<rosbag::Bag> bag_;
  std::string name_;  // without .active
  ros::Time begin_;   // of the file
  std::map<std::string, Recorded> latched_;
  std::string problem_;
  double free_ = 0.0;  // MB
  std::uint64_t closed_bytes_ = 0;
  int files_ = 0;
};

}  // namespace laparoscope_servo
