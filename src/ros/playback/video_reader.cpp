#include "ros/playback/video_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstring>
#include <thread>

#include "ros/playback/image_source.h"

namespace laparoscope_servo {

namespace {

constexpr unsigned kMostThreads = 16;  // of the decoder; each thread delays the output by one picture
// failures of reading or decoding in a row, after which the video counts as damaged
constexpr std::int64_t kMostFailures = 1000;
constexpr std::int64_t kLargestNothing = 19;  // bytes: largest size of an MPEG-4 picture without changes

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
  length_ = VideoLength(*format_, *stream_);
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

Orientation VideoReader::orientation() const {
  const std::uint8_t* data = av_stream_get_side_data(stream_, AV_PKT_DATA_DISPLAYMATRIX, nullptr);
  if (data == nullptr) return {};
  std::array<std::int32_t, 9> matrix{};
  std::memcpy(matrix.data(), data, sizeof matrix);
  return orientationOf(matrix);
}

double VideoReader::pixelAspect() const {
  const double aspect = libav::toDouble(av_guess_sample_aspect_ratio(format_.get(), stream_, nullptr));
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
    const double duration = packet_->duration > 0 ? seconds(packet_->duration) : 0.0;
    if (time != AV_NOPTS_VALUE) length_.read(seconds(time), duration, packet_->size > 0);
    // Some recorders write an empty packet if nothing has changed; for the decoder it would mean the end.
    if (packet_->size > 0) return true;
  }
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
  if (time && last_time_) length_.came(seconds(*time) - *last_time_);
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
  if (!time || !last_time_ || !(rate() > 0.0)) return;
  const std::int64_t hidden = std::llround((*time - *last_time_) * rate()) - 1 - static_cast<std::int64_t>(told);
  if (hidden <= 0) return;
  Picture missing;
  missing.time = *last_time_ + 1.0 / rate();
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
  std::optional<VideoLength::Missing> end = length_.missing(static_cast<std::size_t>(packets_));
  if (!end && (!read_error_.empty() || complaint_)) {
    const std::string why = read_error_.empty() ? "the file ends within a picture" : read_error_;
    end = VideoLength::Missing{1, length_.whereItBreaksOff() + " (" + why + ")"};
  }
  if (!end) return;
  Picture missing;
  missing.time = length_.end();
  missing.count = end->count;
  missing.error = end->error;
  ready_.push_back(std::move(missing));
}

}  // namespace laparoscope_servo
