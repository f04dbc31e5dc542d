// Reads the pictures of a video file in display order, and finds missing ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "ros/playback/libav.h"
#include "ros/playback/pending_pictures.h"
#include "ros/playback/picture_conversion.h"
#include "ros/playback/video_length.h"

namespace laparoscope_servo {

struct Picture {
  libav::Frame frame;          // null: lost
  std::optional<double> time;  // s, presentation time, from the file's own origin; not all containers have it
  std::string error;           // why it is lost or unusable
  std::size_t count = 1;       // number of lost pictures in a row
};

class VideoReader {
 public:
  // Reads local files only, even if the file refers to others. Throws SourceError with the file and the reason.
  explicit VideoReader(const std::string& path);

  // Empty at the end. Damage is reported by pictures with an error.
  std::optional<Picture> next();

  double rate() const { return length_.rate(); }       // Hz, on average; 0: not known
  std::size_t size() const { return length_.size(); }  // number of pictures by the file; 0: not known
  Orientation orientation() const;                     // orientation of all pictures
  double pixelAspect() const;                          // width of a pixel / height, 1 when not known
  // Number of pictures before the first one shown, which depend on pictures that a cut has removed; no player shows
  // them.
  std::size_t leading() const { return leading_; }

 private:
  struct Close {
    void operator()(AVFormatContext* format) const { avformat_close_input(&format); }
  };

  void openDecoder();
  bool readPacket();
  void send();
  void take(libav::Frame frame);
  void tellHidden(std::int64_t index, const std::optional<double>& time, std::size_t told);
  void addLost(const std::vector<PendingPictures::Sent>& pictures);
  void finish();
  bool isPicture(const AVPacket& packet) const;
  double seconds(std::int64_t time) const { return libav::seconds(time, stream_->time_base); }
  std::optional<double> seconds(PendingPictures::Time time) const;

  std::string path_;
  std::unique_ptr<AVFormatContext, Close> format_;
  AVStream* stream_ = nullptr;
  libav::Codec codec_;
  libav::Packet packet_;
  VideoLength length_;

  PendingPictures pending_;
  std::deque<Picture> ready_;
  std::map<std::int64_t, std::string> damaged_;  // incomplete packets
  std::int64_t packets_ = 0;
  std::optional<std::int64_t> complaint_;  // packet before which the container is damaged
  std::optional<double> last_time_;        // s, time of the last picture returned
  std::int64_t failures_ = 0;              // failures of reading in a row
  std::string read_error_;
  std::string decode_error_;
  std::size_t leading_ = 0;
  bool any_shown_ = false;
  bool all_read_ = false;
  bool ended_ = false;
};

}  // namespace laparoscope_servo
