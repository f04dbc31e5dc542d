#include "ros/recording/case_file.h"

#include <time.h>

#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <stdexcept>

namespace laparoscope_servo {

namespace {

constexpr double kMegabyte = 1e6;
// times min_free: hysteresis, so that recording does not start and stop repeatedly
constexpr double kEnoughAgain = 1.1;

// Uses the wall clock, so that names are meaningful also with simulated time.
std::string dateText() {
  const time_t now = ::time(nullptr);
  tm local{};
  ::localtime_r(&now, &local);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d-%H-%M-%S", &local);
  return text.data();
}

}  // namespace

std::size_t Recorded::bytes() const {
  if (const auto* any = std::get_if<topic_tools::ShapeShifter::ConstPtr>(&message)) return (*any)->size();
  if (const auto* image = std::get_if<sensor_msgs::CompressedImageConstPtr>(&message)) return (*image)->data.size();
  return std::get<std_msgs::StringConstPtr>(message)->data.size();
}

// A topic such as tf_static has several publishers, each with its own frames, so the last message of each sender is
// kept.
bool Recorded::isLatched() const {
  if (!header) return false;
  const auto latching = header->find("latching");
  return latching != header->end() && latching->second == "1";
}

CaseFile::CaseFile(const RecorderConfig& config) : config_(config) {
  std::error_code error;
  std::filesystem::create_directories(config.folder, error);
  if (error) throw std::runtime_error("'" + config.folder + "' cannot be made: " + error.message());
  look();
}

CaseFile::~CaseFile() {
  try {
    close();
  } catch (const std::exception&) {  // the part written before stays under the name of an unfinished file
  }
}

const std::string& CaseFile::look() {
  std::error_code error;
  const auto space = std::filesystem::space(config_.folder, error);
  free_ = error ? 0.0 : static_cast<double>(space.available) / kMegabyte;
  const double needed = problem_.empty() ? config_.min_free : kEnoughAgain * config_.min_free;
  problem_.clear();
  if (error) {
    problem_ = "'" + config_.folder + "' is gone: " + error.message();
  } else if (free_ < needed) {
    problem_ = std::to_string(static_cast<int>(free_)) + " MB are free in '" + config_.folder + "', " +
               std::to_string(static_cast<int>(needed)) + " are needed to record";
  }
  return problem_;
}

bool CaseFile::isFull(const ros::Time& time) const {
  if (!bag_) return true;
  const bool jumped = time < begin_;  // simulated time started again
  return jumped || static_cast<double>(bag_->getSize()) > config_.split_size * kMegabyte ||
         (time - begin_).toSec() > config_.split_duration;
}

void CaseFile::open(const ros::Time& time) {
  std::array<char, 16> number{};
  std::snprintf(number.data(), number.size(), "_%03d", files_);
  name_ = config_.folder + "/" + config_.prefix + "_" + dateText() + number.data() + ".bag";
  bag_ = std::make_unique<rosbag::Bag>(name_ + ".active", rosbag::bagmode::Write);
  ++files_;
  begin_ = time;
  for (const auto& [key, recorded] : latched_) put(recorded, time);
}

void CaseFile::close() {
  if (!bag_) return;
  closed_bytes_ += bag_->getSize();
  const std::unique_ptr<rosbag::Bag> bag = std::move(bag_);
  bag->close();
  std::filesystem::rename(name_ + ".active", name_);
}

void CaseFile::put(const Recorded& recorded, const ros::Time& time) {
  if (const auto* any = std::get_if<topic_tools::ShapeShifter::ConstPtr>(&recorded.message)) {
    bag_->write(recorded.topic, time, **any, recorded.header);
  } else if (const auto* image = std::get_if<sensor_msgs::CompressedImageConstPtr>(&recorded.message)) {
    bag_->write(recorded.topic, time, **image);
  } else {
    bag_->write(recorded.topic, time, *std::get<std_msgs::StringConstPtr>(recorded.message), recorded.header);
  }
}

void CaseFile::write(const Recorded& recorded) {
  if (recorded.isLatched()) latched_[recorded.topic + " " + (*recorded.header)["callerid"]] = recorded;
  try {
    if (isFull(recorded.time)) {
      close();
      open(recorded.time);
      if (recorded.isLatched()) return;  // it was written at the beginning of the file
    }
    put(recorded, recorded.time);
  } catch (const std::exception& error) {
    bag_.reset();
    problem_ = "'" + name_ + "' cannot be written: " + error.what();  // valid until the next look()
    throw std::runtime_error(problem_);
  }
}

}  // namespace laparoscope_servo
