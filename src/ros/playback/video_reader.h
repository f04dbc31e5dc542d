// Reads the pictures of a video file in display order, and finds missing ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>

#include "ros/playback/libav.h"
#include "ros/playback/pending_pictures.h"
#include "ros/playback/picture_conversion.h"

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

  double rate() const { return rate_; }       // Hz, on average; 0: not known
  std::size_t size() const { return size_; }  // number of pictures by the file; 0: not known
  Orientation orientation() const;            // orientation of all pictures
  double pixelAspect() const;                 // width of a pixel / height, 1 when not known
  // Number of pictures before the first one shown, which depend on pictures that a cut has removed; no player shows
  // them.
  std::size_t leading() const { return leading_; }

 private:
  struct Close {
    void operator()(AVFormatContext* format) const { avformat_close_input(&format); }
  };

  void openDecoder();
  void learnLength();
  bool readPacket();
  void addStep(double time);
  void send();
  void take(libav::Frame frame);
  void tellHidden(std::int64_t index, const std::optional<double>& time, std::size_t told);
  void addLost(const std::vector<PendingPictures::Sent>& pictures);
  void finish();
  bool isPicture(const AVPacket& packet) const;
  double seconds(std::int64_t time) const { return static_cast<double>(time) * base_num_ / base_den_; }
  std::optional<double> seconds(PendingPictures::Time time) const;

  std::string path_;
  std::unique_ptr<AVFormatContext, Close> format_;
  AVStream* stream_ = nullptr;
  libav::Codec codec_;
  libav::Packet packet_;
  double base_num_ = 1.0;  // numerator of the stream's time base [s]
  double base_den_ = 1.0;
  double rate_ = 0.0;
  std::size_t size_ = 0;
  std::size_t promised_ = 0;            // number of packets to come; 0: not known
  double promised_end_ = 0.0;           // s, in the file's time; 0: not known
  bool every_period_is_there_ = false;  // promised_end_ is exact

  PendingPictures pending_;
  std::deque<Picture> ready_;
  std::map<std::int64_t, std::string> damaged_;  // incomplete packets
  std::int64_t packets_ = 0;
  std::optional<std::int64_t> complaint_;                           // packet before which the container is damaged
  std::optional<double> last_time_;                                 // s, time of the last picture returned
  double longest_period_ = 0.0;                                     // s, between two pictures
  std::optional<double> last_sent_;                                 // s, time of the last packet with a picture
  double shortest_step_ = std::numeric_limits<double>::infinity();  // s, between two such packets
  std::int64_t failures_ = 0;                                       // failures of reading in a row
  double end_ = 0.0;                                                // s, end of the packets read so far
  std::string read_error_;
  std::string decode_error_;
  std::size_t leading_ = 0;
  bool any_shown_ = false;
  bool all_read_ = false;
  bool ended_ = false;
};

}  // namespace laparoscope_servo
