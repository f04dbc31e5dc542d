// The files of a recording: consecutive bags, each of which can be replayed alone.
//
// A file is NAME.bag.active while it is written. An unfinished file keeps that name; `rosbag reindex` recovers its
// contents.
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
  // connection header; latched topics are written at the beginning of each file
  boost::shared_ptr<ros::M_string> header;
  std::variant<topic_tools::ShapeShifter::ConstPtr, sensor_msgs::CompressedImageConstPtr, std_msgs::StringConstPtr>
      message;
  std::size_t bytes() const;
  bool isLatched() const;
};

class CaseFile {
 public:
  // Creates the folder. Throws std::runtime_error on failure.
  explicit CaseFile(const RecorderConfig& config);
  // Closes the file.
  ~CaseFile();
  CaseFile(const CaseFile&) = delete;
  CaseFile& operator=(const CaseFile&) = delete;

  // Why nothing can be written at present; empty if writing is possible. Checks the disk; call now and then.
  const std::string& look();
  // Starts a new file if there is none, or if the last one is full. Throws std::runtime_error on failure; the file is
  // then closed.
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
  ros::Time begin_;   // time of the file's first message
  std::map<std::string, Recorded> latched_;
  std::string problem_;
  double free_ = 0.0;  // MB
  std::uint64_t closed_bytes_ = 0;
  int files_ = 0;
};

}  // namespace laparoscope_servo
