// Videos.
#include <cstdio>
#include <string>
#include <utility>

#include "ros/playback/image_sources.h"
#include "ros/playback/picture_conversion.h"
#include "ros/playback/video_reader.h"

namespace laparoscope_servo {

namespace {

std::string withDigits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", value);
  return text;
}

// Strictly increasing seconds since the first picture.
class PictureTimes {
 public:
  explicit PictureTimes(double period) : period_(period) {}

  double of(const Picture& picture) {
    if (!first_ && picture.time) first_ = picture.time;
    double time = picture.time ? *picture.time - *first_ + shift_ : last_ + period_;
    const bool behind = any_ && !(time > last_);
    // A missing picture may be detected late; it must not shift the others.
    if (!picture.frame) return behind ? last_ : time;
    if (behind) {
      shift_ += last_ + period_ - time;
      time = last_ + period_;
      ++jumps_;
    }
    if (!any_ && !picture.time) time = 0.0;
    any_ = true;
    last_ = time;
    return time;
  }
  std::size_t jumps() const { return jumps_; }

 private:
  double period_;
  std::optional<double> first_;
  double shift_ = 0.0;
  double last_ = 0.0;
  bool any_ = false;
  std::size_t jumps_ = 0;
};

class VideoSource : public ImageSource {
 public:
  VideoSource(const std::string& path, const SourceOptions& options)
      : path_(path),
        span_(options),
        reader_(path),
        rate_(reader_.rate() > 0.0 ? reader_.rate() : options.folder_rate),
        converter_(reader_.orientation()),
        times_(1.0 / rate_) {}

  std::optional<SourceImage> next() override {
    while (std::optional<Picture> picture = reader_.next()) {
      const double time = times_.of(*picture);
      const std::size_t frame = frame_;
      frame_ += picture->count;
      decoded_ = decoded_ || picture->frame != nullptr;
      if (span_.isSkipped(time)) continue;
      if (span_.isBehind(time)) break;
      return imageOf(*picture, frame, time);
    }
    if (!decoded_) throw SourceError("video '" + path_ + "' has no picture that can be decoded");
    return std::nullopt;
  }

  std::size_t size() const override { return reader_.size(); }
  double rate() const override { return rate_; }
  bool hasRecordedStamps() const override { return false; }
  std::vector<std::string> notes() const override {
    std::vector<std::string> notes;
    const double aspect = reader_.pixelAspect();
    if (aspect < 0.999 || aspect > 1.001) {
      notes.push_back(
          "its pixels are " + withDigits(aspect) +
          " times as wide as high, and are taken as they are stored: a player shows them stretched; ROI and "
          "calibration have to be of the stored ones");
    }
    if (reader_.leading() > 0) {
      notes.push_back(std::to_string(reader_.leading()) +
                      " pictures in front of the first whole one rest on others that are not in the file, and are not "
                      "counted");
    }
    if (times_.jumps() > 0) {
      notes.push_back("its times go back at " + std::to_string(times_.jumps()) +
                      " places: from there on they are counted from the picture before");
    }
    return notes;
  }

 private:
  SourceImage imageOf(const Picture& picture, std::size_t frame, double time) {
    SourceImage image;
    image.frame = frame;
    image.lost = picture.count;
    image.header.stamp = image.record_time = ros::Time(time);
    if (!picture.error.empty()) {
      image.error = "at " + withDigits(time) + " s of '" + path_ + "': " + picture.error;
      return image;
    }
    try {
      image.decoded = converter_.convert(*picture.frame);
    } catch (const std::runtime_error& error) {
      image.error = "at " + withDigits(time) + " s of '" + path_ + "': " + error.what();
    }
    return image;
  }

  std::string path_;
  ImageSpan span_;
  VideoReader reader_;
  double rate_;
  PictureConverter converter_;
  PictureTimes times_;
  std::size_t frame_ = 0;
  bool decoded_ = false;  // at least one picture was decoded
};

}  // namespace

std::unique_ptr<ImageSource> openVideoSource(const std::string& path, const SourceOptions& options) {
  return std::make_unique<VideoSource>(path, options);
}

}  // namespace laparoscope_servo
