#include "ros/camera/camera_source.h"

#include <time.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <thread>

namespace laparoscope_servo {

namespace {

// s, largest age of a picture; a larger one means that the device uses another clock
constexpr double kOldest = 1.0;
constexpr double kUsualRate = 25.0;  // Hz, for a file without a frame rate

double monotonicNow() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

bool isDevice(const std::string& name) {
  std::error_code ignored;
  return std::filesystem::is_character_file(name, ignored);
}

bool isFile(const std::string& name) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(name, ignored);
}

}  // namespace

ros::Time captureStamp(double captured, double monotonic_now, const ros::Time& now) {
  const double age = monotonic_now - captured;
  if (!(age >= 0.0 && age <= kOldest) || now.toSec() <= age) return now;
  return now - ros::Duration(age);
}

CameraSource::CameraSource(const CameraConfig& config)
    : config_(config), is_video4linux_(isDevice(config.device)), is_file_(isFile(config.device)) {
  const std::string& device = config.device;
  if (!is_video4linux_ && !is_file_ && device.find("://") == std::string::npos) {
    throw std::runtime_error("'" + device +
                             "' is not there, expected a device such as /dev/video0, a file, or an address with ://");
  }
  const bool opened = capture_.open(device, is_video4linux_ ? cv::CAP_V4L2 : cv::CAP_FFMPEG);
  if (!opened) {
    throw std::runtime_error("'" + device + "' cannot be opened: is it used by another program, and may you read it?");
  }
  if (!config.pixel_format.empty()) {
    const std::string& f = config.pixel_format;
    ask(cv::CAP_PROP_FOURCC, cv::VideoWriter::fourcc(f[0], f[1], f[2], f[3]), "pixel_format");
  }
  if (config.width > 0) {
    ask(cv::CAP_PROP_FRAME_WIDTH, config.width, "width");
    ask(cv::CAP_PROP_FRAME_HEIGHT, config.height, "height");
  }
  if (config.rate > 0.0) ask(cv::CAP_PROP_FPS, config.rate, "rate");
  if (config.bayer != BayerPattern::kNone && is_video4linux_) capture_.set(cv::CAP_PROP_CONVERT_RGB, 0.0);
  due_ = std::chrono::steady_clock::now();
}

void CameraSource::ask(int property, double value, const char* what) {
  if (is_file_) return;
  capture_.set(property, value);
  if (std::abs(capture_.get(property) - value) <= 0.01 * value) return;
  notes_ += std::string(notes_.empty() ? "" : ", ") + what + " is not as asked for";
}

void CameraSource::pace() {
  const double told = config_.rate > 0.0 ? config_.rate : capture_.get(cv::CAP_PROP_FPS);
  const double rate = told > 0.1 && told < 1000.0 ? told : kUsualRate;
  std::this_thread::sleep_until(due_);
  due_ += std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(1.0 / rate));
}

ros::Time CameraSource::stamp() const {
  const ros::Time now = ros::Time::now();
  const ros::Time taken = device_time_ > 0.0 ? captureStamp(1e-3 * device_time_, monotonicNow(), now) : now;
  return taken.toSec() > config_.delay ? taken - ros::Duration(config_.delay) : taken;
}

std::optional<CameraSource::Picture> CameraSource::next() {
  if (is_file_) pace();
  if (!capture_.grab()) {
    throw std::runtime_error("'" + config_.device +
                             (is_file_ ? "' has ended" : "' gives no picture any more: unplugged, or no signal?"));
  }
  if (is_video4linux_) {
    const double time = capture_.get(cv::CAP_PROP_POS_MSEC);
    if (time > 0.0 && time == device_time_) return std::nullopt;
    device_time_ = time;
  }
  Picture picture;
  picture.stamp = stamp();
  cv::Mat shared;
  if (!capture_.retrieve(shared) || shared.empty()) {
    throw std::runtime_error("a picture of '" + config_.device + "' cannot be decoded");
  }
  picture.image = deinterlaced(colourOf(shared, config_.bayer), config_.interlacing);
  // The capture may reuse this picture's memory for the next one.
  if (picture.image.data == shared.data) picture.image = shared.clone();
  return picture;
}

}  // namespace laparoscope_servo
