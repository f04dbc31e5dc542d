// How long a video is by its file, and whether all of it has come.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "ros/playback/libav.h"

namespace laparoscope_servo {

// Times are seconds, from the file's own origin.
class VideoLength {
 public:
  VideoLength() = default;
  VideoLength(AVFormatContext& format, AVStream& stream);

  double rate() const { return rate_; }       // Hz, on average; 0: not known
  std::size_t size() const { return size_; }  // number of pictures by the file; 0: not known

  // A packet that begins at `time`, in the order of the file. `duration` 0: not known. `shows`: it holds a picture.
  void read(double time, double duration, bool shows);
  // Two pictures came one after the other, so far apart.
  void came(double period);

  struct Missing {
    std::size_t count = 1;  // pictures
    std::string error;
  };
  // When the file has ended after so many packets; empty when it has kept what it promised.
  std::optional<Missing> missing(std::size_t packets) const;
  // Of what has been read.
  double end() const;
  std::string whereItBreaksOff() const;

 private:
  double period() const;

  double rate_ = 0.0;
  std::size_t size_ = 0;
  std::size_t promised_ = 0;                                        // number of packets to come; 0: not known
  double promised_end_ = 0.0;                                       // 0: not known
  bool every_period_is_there_ = false;                              // promised_end_ is exact
  double end_ = 0.0;                                                // of the packets read so far
  std::optional<double> last_sent_;                                 // of the last packet with a picture
  double shortest_step_ = std::numeric_limits<double>::infinity();  // between two such packets
  double longest_period_ = 0.0;                                     // between two pictures
};

}  // namespace laparoscope_servo
