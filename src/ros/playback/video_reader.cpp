#include "ros/playback/video_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <thread>

#include "ros/playback/image_source.h"

namespace laparoscope_servo {

namespace {

constexpr unsigned kMostThreads = 16;  // of the decoder; each thread delays the output by one picture
// failures of reading or decoding in a row, after which the video counts as damaged
constexpr std::int64_t kMostFailures = 1000;
// A video may end this many of its longest periods before the end given in its header, since the last period is not
// always known.
constexpr double kMissingPeriods = 1.5;
constexpr std::int64_t kLargestNothing = 19;  // bytes: largest size of an MPEG-4 picture without changes

double toDouble(AVRational value) {
  return value.num > 0 && value.den > 0 ? av_q2d(value) : 0.0;
}

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
  return 3600.0 * hours + 60.0 * minutes + seconds;
}

std::string timeText(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f s", seconds);
  return text;
}

// libav reports damage of a container only by log messages, in the thread that reads.
thread_local const void* listening_to = nullptr;
thread_local bool complained = false;

void onMessage(void* object, int level, const char* /*format*/, va_list /*arguments*/) {
  if (object != nullptr && object == listening_to && level <= AV_LOG_ERROR) complained = true;
}

// Codecs for which libav reports damage only by log messages, which then count as errors; no other picture depends on
// these pictures.
bool standsAlone(AVCodecID id) {
  const AVCodecDescriptor* descriptor = avcodec_descriptor_get(id);
  const bool intra = descriptor != nullptr && (descriptor->props & AV_CODEC_PROP_INTRA_ONLY) != 0;
  return intra || id == AV_CODEC_ID_FFV1;
}

}  // namespace

VideoReader::VideoReader(const std::string& path) : path_(path), packet_(av_packet_alloc()) {
  av_log_set_callback(onMessage);  // damage of a video is reported by this class instead
  const std::string refused = "'" + path + "' cannot be opened as a video (";
  const std::string expected = "), expected a bag, a folder of images or a whole video that libav can decode";
  AVDictionary* options = nullptr;
  av_dict_set(&options, "protocol_whitelist", "file", 0);
  AVFormatContext* format = nullptr;
  int result = avformat_open_input(&format, libav::fileUrl(path).c_str(), nullptr, &options);
  av_dict_free(&options);
  if (result < 0) throw SourceError(refused + libav::errorText(result) + expected);
  format_.reset(format);
  result = avformat_find_stream_info(format, nullptr);
  if (result >= 0) result = av_find_best_stream(format, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (result < 0) throw SourceError(refused + libav::errorText(result) + expected);
  stream_ = format->streams[result];
  for (unsigned k = 0; k < format->nb_streams; ++k) {
    if (format->streams[k] != stream_) format->streams[k]->discard = AVDISCARD_ALL;
  }
  openDecoder();
  learnLength();
}

void VideoReader::openDecoder() {
  const auto refuse = [this](const std::string& why) {
    throw SourceError("'" + path_ + "' cannot be decoded as a video in " +
                      avcodec_get_name(stream_->codecpar->codec_id) + ": " + why);
  };
  const AVCodec* codec = avcodec_find_decoder(stream_->codecpar->codec_id);
  if (codec == nullptr) refuse("libav has no decoder for it");
  codec_.reset(avcodec_alloc_context3(codec));
  int result = avcodec_parameters_to_context(codec_.get(), stream_->codecpar);
  if (standsAlone(codec_->codec_id)) codec_->err_recognition |= AV_EF_EXPLODE | AV_EF_CRCCHECK;
  codec_->pkt_timebase = stream_->time_base;
  // On more threads libav conceals damage within a picture with the one before, and often does not mark it.
  codec_->thread_count = standsAlone(codec_->codec_id)
                             ? static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, kMostThreads))
                             : 1;
  if (result >= 0) result = avcodec_open2(codec_.get(), codec, nullptr);
  if (result < 0) refuse(libav::errorText(result));
}

void VideoReader::learnLength() {
  base_num_ = stream_->time_base.num;
  base_den_ = stream_->time_base.den;
  rate_ = toDouble(stream_->avg_frame_rate);
  if (!(rate_ > 0.0)) rate_ = toDouble(av_guess_frame_rate(format_.get(), stream_, nullptr));
  size_ = stream_->nb_frames > 0 ? static_cast<std::size_t>(stream_->nb_frames) : 0;
  double duration = stream_->duration != AV_NOPTS_VALUE ? seconds(stream_->duration) : 0.0;
  const std::string name = format_->iformat->name;
  if (name.find("mp4") != std::string::npos && indexEntries(stream_) > 0) {
    // The index does not have the pictures that an edit list cuts off, so its size is the number of pictures to come.
    promised_ = size_ = static_cast<std::size_t>(indexEntries(stream_));
  } else if (name == "avi" && size_ > 0) {
    // Also counts omitted pictures, which have no packet; each takes one unit of time.
    promised_end_ = seconds(stream_->nb_frames);
    every_period_is_there_ = true;
  } else if (name.find("matroska") != std::string::npos) {
    promised_end_ = durationTag(*stream_);
    // With several streams, any may be the longest.
    const bool alone = format_->nb_streams == 1 && format_->duration_estimation_method == AVFMT_DURATION_FROM_STREAM;
    if (!(promised_end_ > 0.0) && alone) promised_end_ = static_cast<double>(format_->duration) / AV_TIME_BASE;
  }
  if (!(duration > 0.0) && format_->duration > 0) duration = static_cast<double>(format_->duration) / AV_TIME_BASE;
  if (size_ == 0) size_ = static_cast<std::size_t>(std::max(0L, std::lround(duration * rate_)));
}

Orientation VideoReader::orientation() const {
  const std::uint8_t* data = av_stream_get_side_data(stream_, AV_PKT_DATA_DISPLAYMATRIX, nullptr);
  if (data == nullptr) return {};
  std::array<std::int32_t, 9> matrix{};
  std::memcpy(matrix.data(), data, sizeof matrix);
  return orientationOf(matrix);
}

double VideoReader::pixelAspect() const {
  const double aspect = toDouble(av_guess_sample_aspect_ratio(format_.get(), stream_, nullptr));
  return aspect > 0.0 ? aspect : 1.0;
}

std::optional<double> VideoReader::seconds(PendingPictures::Time time) const {
  if (!time) return std::nullopt;
  return seconds(*time);
}

std::optional<Picture> VideoReader::next() {
  for (std::int64_t errors = 0; ready_.empty() && !ended_;) {
    libav::Frame frame(av_frame_alloc());
    const int result = avcodec_receive_frame(codec_.get(), frame.get());
    if (result == 0) {
      take(std::move(frame));
    } else if (result == AVERROR(EAGAIN) && !all_read_) {
      send();
    } else if (result == AVERROR(EAGAIN) || result == AVERROR_EOF || ++errors > kMostFailures) {
      finish();
    } else {
      decode_error_ = libav::errorText(result);
    }
  }
  if (ready_.empty()) return std::nullopt;
  Picture picture = std::move(ready_.front());
  ready_.pop_front();
  return picture;
}

// Whether the packet holds a picture that is to be shown.
bool VideoReader::isPicture(const AVPacket& packet) const {
  if ((packet.flags & AV_PKT_FLAG_DISCARD) != 0) return false;
  if (codec_->codec_id == AV_CODEC_ID_VP8) return (packet.data[0] & 0x10) != 0;
  return codec_->codec_id != AV_CODEC_ID_MPEG4 || packet.size > kLargestNothing;
}

// Returns false at the end.
bool VideoReader::readPacket() {
  for (;;) {
    av_packet_unref(packet_.get());
    listening_to = format_.get();
    complained = false;
    const int result = av_read_frame(format_.get(), packet_.get());
    listening_to = nullptr;
    if (complained && !complaint_) complaint_ = packets_ + 1;
    if (result == AVERROR_EOF) return false;
    if (result < 0) {
      read_error_ = libav::errorText(result);
      if (++failures_ > kMostFailures || (format_->pb != nullptr && avio_feof(format_->pb) != 0)) return false;
      continue;
    }
    failures_ = 0;
    if (packet_->stream_index != stream_->index) continue;
    ++packets_;
    const std::int64_t time = packet_->pts != AV_NOPTS_VALUE ? packet_->pts : packet_->dts;
    const double period = packet_->duration > 0 ? seconds(packet_->duration) : rate_ > 0.0 ? 1.0 / rate_ : 0.0;
    if (time != AV_NOPTS_VALUE) {
      end_ = std::max(end_, seconds(time) + period);
      if (packet_->size > 0) addStep(seconds(time));
    }
    // Some recorders write an empty packet if nothing has changed; for the decoder it would mean the end.
    if (packet_->size > 0) return true;
  }
}

void VideoReader::addStep(double time) {
  if (last_sent_ && time > *last_sent_) shortest_step_ = std::min(shortest_step_, time - *last_sent_);
  last_sent_ = time;
}

void VideoReader::send() {
  if (!readPacket()) {
    all_read_ = true;
    avcodec_send_packet(codec_.get(), nullptr);
    return;
  }
  const std::int64_t index = packets_;
  if (isPicture(*packet_)) {
    PendingPictures::Sent picture;
    if (packet_->pts != AV_NOPTS_VALUE) picture.time = packet_->pts;
    picture.key = (packet_->flags & AV_PKT_FLAG_KEY) != 0;
    pending_.sent(index, picture);
  }
  // In a transport stream a packet is marked corrupt if its counter jumps, also where two streams were joined; there
  // only the decoder can tell.
  const bool transport = std::strcmp(format_->iformat->name, "mpegts") == 0;
  if ((packet_->flags & AV_PKT_FLAG_CORRUPT) != 0 && !transport) damaged_[index] = "its data are damaged or cut off";
  codec_->reordered_opaque = index;
  const int result = avcodec_send_packet(codec_.get(), packet_.get());
  if (result < 0) decode_error_ = libav::errorText(result);
}

void VideoReader::take(libav::Frame frame) {
  const std::int64_t index = frame->reordered_opaque;
  const PendingPictures::Time time = frame->best_effort_timestamp != AV_NOPTS_VALUE
                                         ? PendingPictures::Time(frame->best_effort_timestamp)
                                         : std::nullopt;
  const std::vector<PendingPictures::Sent> lost = pending_.came(index, time);
  tellHidden(index, seconds(time), lost.size());
  addLost(lost);
  any_shown_ = true;
  if (time && last_time_) longest_period_ = std::max(longest_period_, seconds(*time) - *last_time_);
  last_time_ = seconds(time);
  Picture picture;
  picture.time = seconds(time);
  const auto damage = damaged_.find(index);
  if (damage != damaged_.end()) {
    picture.error = damage->second;
    damaged_.erase(damage);
  } else if (frame->decode_error_flags != 0 || (frame->flags & AV_FRAME_FLAG_CORRUPT) != 0) {
    picture.error = "parts of it could not be decoded";
  }
  picture.frame = std::move(frame);
  ready_.push_back(std::move(picture));
}

// Reports a gap in the times at a damaged place of the container: its pictures are missing. A gap without damage is no
// error, since some cameras omit pictures.
void VideoReader::tellHidden(std::int64_t index, const std::optional<double>& time, std::size_t told) {
  if (!complaint_ || index < *complaint_) return;
  complaint_.reset();
  if (!time || !last_time_ || !(rate_ > 0.0)) return;
  const std::int64_t hidden = std::llround((*time - *last_time_) * rate_) - 1 - static_cast<std::int64_t>(told);
  if (hidden <= 0) return;
  Picture missing;
  missing.time = *last_time_ + 1.0 / rate_;
  missing.count = static_cast<std::size_t>(hidden);
  missing.error = "the file is damaged here, and " + std::to_string(hidden) + " pictures are missing";
  ready_.push_back(std::move(missing));
}

void VideoReader::addLost(const std::vector<PendingPictures::Sent>& pictures) {
  const bool cut = std::none_of(pictures.begin(), pictures.end(), [](const auto& picture) { return picture.key; });
  if (!any_shown_ && cut) {
    leading_ += pictures.size();
    return;
  }
  for (const PendingPictures::Sent& picture : pictures) {
    Picture lost;
    lost.time = seconds(picture.time);
    lost.error = decode_error_.empty() ? "it cannot be decoded" : "it cannot be decoded (" + decode_error_ + ")";
    ready_.push_back(std::move(lost));
  }
}

// At the end of the file, checks whether the video is complete.
void VideoReader::finish() {
  ended_ = true;
  addLost(pending_.end());
  double period = 1.0 / rate_;
  if (every_period_is_there_ && std::isfinite(shortest_step_)) {
    // The unit in which an AVI counts may be shorter than each of its pictures lasts, as the last one does.
    end_ += std::max(0.0, shortest_step_ - period);
    period = std::max(shortest_step_, period);
  }
  Picture missing;
  missing.time = end_;
  const std::string where = "the video breaks off at " + timeText(end_);
  const auto read = static_cast<std::size_t>(packets_);
  const double tolerance = every_period_is_there_ ? 0.5 * period : kMissingPeriods * std::max(longest_period_, period);
  if (read < promised_) {
    missing.count = promised_ - read;
    missing.error = where + ": " + std::to_string(missing.count) + " of its " + std::to_string(promised_) +
                    " pictures are not in the file";
  } else if (promised_end_ > 0.0 && rate_ > 0.0 && end_ + tolerance < promised_end_) {
    missing.count = static_cast<std::size_t>(std::lround((promised_end_ - end_) / period));
    missing.error = where + ", expected at " + timeText(promised_end_);
  } else if (!read_error_.empty() || complaint_) {
    missing.error = where + " (" + (read_error_.empty() ? "the file ends within a picture" : read_error_) + ")";
  } else {
    return;
  }
  ready_.push_back(std::move(missing));
}

}  // namespace laparoscope_servo
