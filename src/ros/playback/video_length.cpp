#include "ros/playback/video_length.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace laparoscope_servo {

namespace {

// A video may end this many of its longest periods before the end given in its header, since the last period is not
// always known.
constexpr double kMissingPeriods = 1.5;

std::int64_t indexEntries(AVStream* stream) {
#if LIBAVFORMAT_VERSION_MAJOR >= 59
  return avformat_index_get_entries_count(stream);
#else
  return stream->nb_index_entries;
#endif
}

// Parses Matroska's tag 00:00:03.200000000; 0 if there is none.
double durationTag(const AVStream& stream) {
  const AVDictionaryEntry* tag = av_dict_get(stream.metadata, "DURATION", nullptr, 0);
  int hours = 0;
  int minutes = 0;
  double seconds = 0.0;
  if (tag == nullptr || std::sscanf(tag->value, "%d:%d:%lf", &hours, &minutes, &seconds) != 3) return 0.0;
  const double duration = 3600.0 * hours + 60.0 * minutes + seconds;
  return std::isfinite(duration) ? duration : 0.0;
}

std::string timeText(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f s", seconds);
  return text;
}

}  // namespace

VideoLength::VideoLength(AVFormatContext& format, AVStream& stream) {
  rate_ = libav::toDouble(stream.avg_frame_rate);
  if (!(rate_ > 0.0)) rate_ = libav::toDouble(av_guess_frame_rate(&format, &stream, nullptr));
  size_ = stream.nb_frames > 0 ? static_cast<std::size_t>(stream.nb_frames) : 0;
  double duration = stream.duration != AV_NOPTS_VALUE ? libav::seconds(stream.duration, stream.time_base) : 0.0;
  const std::string name = format.iformat->name;
  if (name.find("mp4") != std::string::npos && indexEntries(&stream) > 0) {
    // The index does not have the pictures that an edit list cuts off, so its size is the number of pictures to come.
    promised_ = size_ = static_cast<std::size_t>(indexEntries(&stream));
  } else if (name == "avi" && size_ > 0) {
    // Also counts omitted pictures, which have no packet; each takes one unit of time.
    promised_end_ = libav::seconds(stream.nb_frames, stream.time_base);
    every_period_is_there_ = true;
  } else if (name.find("matroska") != std::string::npos) {
    promised_end_ = durationTag(stream);
    // With several streams, any may be the longest.
    const bool alone = format.nb_streams == 1 && format.duration_estimation_method == AVFMT_DURATION_FROM_STREAM;
    if (!(promised_end_ > 0.0) && alone) promised_end_ = static_cast<double>(format.duration) / AV_TIME_BASE;
  }
  if (!(duration > 0.0) && format.duration > 0) duration = static_cast<double>(format.duration) / AV_TIME_BASE;
  if (size_ == 0) size_ = static_cast<std::size_t>(std::max(0L, std::lround(duration * rate_)));
}

void VideoLength::read(double time, double duration, bool shows) {
  const double period = duration > 0.0 ? duration : rate_ > 0.0 ? 1.0 / rate_ : 0.0;
  end_ = std::max(end_, time + period);
  if (!shows) return;
  if (last_sent_ && time > *last_sent_) shortest_step_ = std::min(shortest_step_, time - *last_sent_);
  last_sent_ = time;
}

void VideoLength::came(double period) {
  longest_period_ = std::max(longest_period_, period);
}

// The unit in which an AVI counts may be shorter than each of its pictures lasts, as the last one does.
double VideoLength::period() const {
  const double usual = 1.0 / rate_;
  return every_period_is_there_ && std::isfinite(shortest_step_) ? std::max(shortest_step_, usual) : usual;
}

double VideoLength::end() const {
  return every_period_is_there_ && std::isfinite(shortest_step_) ? end_ + std::max(0.0, shortest_step_ - 1.0 / rate_)
                                                                 : end_;
}

std::string VideoLength::whereItBreaksOff() const {
  return "the video breaks off at " + timeText(end());
}

std::optional<VideoLength::Missing> VideoLength::missing(std::size_t packets) const {
  if (packets < promised_) {
    const std::size_t count = promised_ - packets;
    return Missing{count, whereItBreaksOff() + ": " + std::to_string(count) + " of its " + std::to_string(promised_) +
                              " pictures are not in the file"};
  }
  const double tolerance =
      every_period_is_there_ ? 0.5 * period() : kMissingPeriods * std::max(longest_period_, period());
  if (!(promised_end_ > 0.0 && rate_ > 0.0 && end() + tolerance < promised_end_)) return std::nullopt;
  return Missing{static_cast<std::size_t>(std::lround((promised_end_ - end()) / period())),
                 whereItBreaksOff() + ", expected at " + timeText(promised_end_)};
}

}  // namespace laparoscope_servo
