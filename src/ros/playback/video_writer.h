// Writes a video file and reports all errors. (OpenCV's writer does not report a full disk.)
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <string>

#include "ros/playback/libav.h"

namespace laparoscope_servo {

class VideoWriter {
 public:
  // Whether the name ends in .mp4, .mkv, .mov (MPEG-4) or .avi (Motion JPEG).
  static bool knows(const std::string& name);

  // Writes to `path` in the format of the extension of `name`. All functions throw std::runtime_error with libav's
  // error.
  VideoWriter(const std::string& name, const std::string& path, const cv::Size& size, double rate);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  // `image`: CV_8UC3 of the given size.
  void write(const cv::Mat& image);
  // Without this call the file is incomplete.
  void close();

 private:
  void check(int result, const char* what) const;
  void openEncoder(const cv::Size& size, double rate);
  void encode(const AVFrame* frame);

  std::string name_;
  AVFormatContext* format_ = nullptr;
  AVStream* stream_ = nullptr;
  libav::Codec codec_;
  libav::Scaler scaler_;
  libav::Frame frame_;
  libav::Packet packet_;
  std::int64_t written_ = 0;
};

}  // namespace laparoscope_servo
