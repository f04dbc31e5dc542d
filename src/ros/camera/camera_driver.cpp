#include "ros/camera/camera_driver.h"

#include <sensor_msgs/Image.h>

#include <chrono>
#include <exception>
#include <filesystem>

#include "ros/common/clocks.h"
#include "ros/common/quiet_thread.h"
#include "ros/tracker/camera_info.h"
#include "ros/tracker/image_conversion.h"
#include "ros/tracker/result_messages.h"

namespace laparoscope_servo {

namespace {

// A file given by name must exist; the one for the camera's name need not.
std::string existingCalibration(const CameraConfig& config) {
  if (!config.calibration.empty()) return config.calibration;
  const std::string file = calibrationFile(config.name);
  return std::filesystem::exists(file) ? file : "";
}

std::string sizeText(std::uint64_t width, std::uint64_t height) {
  return std::to_string(width) + "x" + std::to_string(height) + " px";
}

}  // namespace

CameraDriver::CameraDriver(ros::NodeHandle node, ros::NodeHandle private_node, const CameraConfig& config)
    : config_(config),
      calibration_file_(existingCalibration(config)),
      image_publisher_(node.advertise<sensor_msgs::Image>("image_raw", 2)),
      camera_info_publisher_(node.advertise<sensor_msgs::CameraInfo>("camera_info", 2)),
      diagnostics_(node, private_node, private_node.getNamespace()),
      last_picture_(steadyNow()),
      told_at_(last_picture_) {
  if (!calibration_file_.empty()) {
    camera_info_ = readCameraInfo(calibration_file_);
  } else {
    calibration_problem_ = "not calibrated: " + calibrationFile(config.name) + " is not there";
    ROS_WARN_STREAM(private_node.getNamespace() << ": " << calibration_problem_);
  }
  diagnostics_.setHardwareID(config.device);
  diagnostics_.add("camera", this, &CameraDriver::diagnose);
  diagnostics_timer_ =
      node.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
  thread_ = startQuietThread([this] { run(); });
}

CameraDriver::~CameraDriver() {
  ends_ = true;
  thread_.join();
}

void CameraDriver::run() {
  while (!ends_) {
    try {
      CameraSource source(config_);
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        ++openings_;
        notes_ = source.notes();
      }
      play(source);
    } catch (const std::exception& error) {  // includes cv::Exception
      lost(error.what());
    }
    wait(config_.retry_period);
  }
}

void CameraDriver::play(CameraSource& source) {
  while (!ends_) {
    const auto picture = source.next();
    if (picture) {
      publish(*picture);
    } else {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++repeated_;
    }
  }
}

void CameraDriver::wait(double seconds) const {
  const double end = steadyNow() + seconds;
  while (!ends_ && steadyNow() < end) std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

void CameraDriver::lost(const std::string& why) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (problem_ != why) ROS_ERROR_STREAM("camera: " << why << "; it is tried again");
  problem_ = why;
}

void CameraDriver::publish(const CameraSource::Picture& picture) {
  std_msgs::Header header;
  header.stamp = picture.stamp;
  header.frame_id = config_.frame_id;
  const sensor_msgs::ImagePtr message = imageMessage(header, trackerImage(picture.image));
  sensor_msgs::CameraInfo info = camera_info_;
  std::string problem;
  if (calibration_file_.empty()) {
    problem = calibration_problem_;
  } else if (info.width != message->width || info.height != message->height) {
    problem = "the calibration '" + calibration_file_ + "' is for pictures of " + sizeText(info.width, info.height) +
              ", but these have " + sizeText(message->width, message->height);
    info = sensor_msgs::CameraInfo();  // all zero, so that it cannot be taken for a calibration
  }
  info.header = header;
  info.width = message->width;
  info.height = message->height;
  camera_info_publisher_.publish(info);
  image_publisher_.publish(message);

  const std::lock_guard<std::mutex> lock(mutex_);
  const std::string size = sizeText(message->width, message->height);
  if (!problem_.empty() || size != size_)
    ROS_INFO_STREAM("camera: pictures of " << size << " come from " << config_.device);
  if (problem != calibration_problem_) ROS_ERROR_STREAM("camera: " << problem);
  calibration_problem_ = problem;
  problem_.clear();
  size_ = size;
  last_picture_ = steadyNow();
  ++pictures_;
}

void CameraDriver::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const std::lock_guard<std::mutex> lock(mutex_);
  const double now = steadyNow();
  const double silence = now - last_picture_;
  if (!problem_.empty()) {
    status.summary(DiagnosticStatus::ERROR, problem_);
  } else if (silence > config_.max_silence) {
    status.summaryf(DiagnosticStatus::ERROR, "no picture for %.1f s", silence);
  } else if (!calibration_problem_.empty()) {
    status.summary(DiagnosticStatus::WARN, calibration_problem_);
  } else if (!notes_.empty()) {
    status.summary(DiagnosticStatus::WARN, notes_);
  } else {
    status.summary(DiagnosticStatus::OK, "pictures come");
  }
  status.add("device", config_.device);
  status.add("size", size_);
  status.addf("rate [Hz]", "%.1f", static_cast<double>(pictures_ - told_pictures_) / std::max(now - told_at_, 1e-3));
  status.add("pictures", pictures_);
  status.add("pictures repeated by the device, left out", repeated_);
  status.add("times opened", openings_);
  status.add("calibration", calibration_file_.empty() ? "none" : calibration_file_);
  told_pictures_ = pictures_;
  told_at_ = now;
}

}  // namespace laparoscope_servo
