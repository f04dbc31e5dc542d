// The node `recorder`: writes a case into bags. Subscribes: image (sensor_msgs/Image), which is recorded as
// <image>/compressed, and the topics of its configuration, of any type. Also writes session (std_msgs/String), with
// versions, parameters and calibration files. Publishes: /diagnostics.
//
// It never blocks publishers: messages that come faster than processor and disk can handle are dropped and counted.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <topic_tools/shape_shifter.h>

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "ros/recording/case_file.h"
#include "ros/recording/image_encoders.h"
#include "ros/recording/recorder_config.h"

namespace laparoscope_servo {

class Recorder {
 public:
  // Throws std::runtime_error if the folder cannot be created.
  Recorder(ros::NodeHandle node, ros::NodeHandle private_node, const RecorderConfig& config);
  // Writes the waiting messages, closes the file, and copies the log of the arm's serial line beside it.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

 private:
  void subscribe(const std::string& topic);
  void add(Recorded recorded);
  void addSession();
  void run();
  void write(std::deque<Recorded>& batch);
  void look(double now);
  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);
  void copyWireLog() const;

  RecorderConfig config_;
  ros::NodeHandle node_;
  CaseFile file_;  // used by the writer's thread only
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Recorded> waiting_;
  double waiting_bytes_ = 0.0;
  bool ends_ = false;
  struct Told {  // figures of the writer, for diagnostics
    std::string problem, file;
    double free = 0.0;  // MB
    std::uint64_t written = 0, dropped = 0, unwritten = 0, bytes = 0;
    int files = 0;
  } told_;
  double next_look_ = 0.0;     // s, steady
  bool stands_still_ = false;  // state of the last line in the log

  std::unique_ptr<ImageEncoders> encoders_;
  std::thread thread_;
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer diagnostics_timer_;
  std::string wire_log_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace laparoscope_servo
