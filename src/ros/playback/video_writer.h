// A video file, written so that whatever goes wrong is known. (OpenCV's writer does not tell that the disk is full.)
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

  // Writes to `path` what the ending of `name` stands for. Throws std::runtime_error, as all do: what libav says.
  VideoWriter(const std::string& name, const std::string& path, const cv::Size& size, double rate);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  // CV_8UC3 of the size given.
  void write(const cv::Mat& image);
  // Nothing is whole without it.
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
