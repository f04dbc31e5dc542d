#include "ros/playback/video_writer.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <stdexcept>

namespace laparoscope_servo {

namespace {

constexpr int kQuality = 3;              // quantiser, 1 (best) to 31
constexpr int kLargestTimeBase = 65535;  // largest time base of MPEG-4

std::string endingOf(const std::string& name) {
  std::string ending = std::filesystem::path(name).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

}  // namespace

bool VideoWriter::knows(const std::string& name) {
  constexpr std::array<const char*, 4> kEndings{".mp4", ".avi", ".mkv", ".mov"};
  return std::find(kEndings.begin(), kEndings.end(), endingOf(name)) != kEndings.end();
}

VideoWriter::VideoWriter(const std::string& name, const std::string& path, const cv::Size& size, double rate)
    : name_(name), frame_(av_frame_alloc()), packet_(av_packet_alloc()) {
  av_log_set_level(AV_LOG_FATAL);
  check(avformat_alloc_output_context2(&format_, nullptr, nullptr, ("x" + endingOf(name)).c_str()), "format");
  try {
    openEncoder(size, rate);
    check(avio_open(&format_->pb, libav::fileUrl(path).c_str(), AVIO_FLAG_WRITE), "open");
    check(avformat_write_header(format_, nullptr), "write");
  } catch (...) {
    avio_closep(&format_->pb);
    avformat_free_context(format_);
    throw;
  }
}

VideoWriter::~VideoWriter() {
  avio_closep(&format_->pb);
  avformat_free_context(format_);
}

void VideoWriter::check(int result, const char* what) const {
  if (result < 0) {
    throw std::runtime_error("'" + name_ + "' cannot be written: " + what + ": " + libav::errorText(result));
  }
}

void VideoWriter::openEncoder(const cv::Size& size, double rate) {
  const bool motion_jpeg = endingOf(name_) == ".avi";
  const AVCodec* encoder = avcodec_find_encoder(motion_jpeg ? AV_CODEC_ID_MJPEG : AV_CODEC_ID_MPEG4);
  check(encoder == nullptr ? AVERROR_ENCODER_NOT_FOUND : 0, "encoder");
  codec_.reset(avcodec_alloc_context3(encoder));
  codec_->width = size.width;
  codec_->height = size.height;
  codec_->pix_fmt = motion_jpeg ? AV_PIX_FMT_YUVJ420P : AV_PIX_FMT_YUV420P;
  codec_->framerate = av_d2q(rate, kLargestTimeBase);
  codec_->time_base = av_inv_q(codec_->framerate);
  codec_->flags |= AV_CODEC_FLAG_QSCALE;
  codec_->global_quality = FF_QP2LAMBDA * kQuality;
  if ((format_->oformat->flags & AVFMT_GLOBALHEADER) != 0) codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  check(avcodec_open2(codec_.get(), encoder, nullptr), "encoder");
  stream_ = avformat_new_stream(format_, nullptr);
  check(stream_ == nullptr ? AVERROR(ENOMEM) : 0, "stream");
  stream_->time_base = codec_->time_base;
  stream_->avg_frame_rate = codec_->framerate;
  check(avcodec_parameters_from_context(stream_->codecpar, codec_.get()), "stream");

  frame_->format = codec_->pix_fmt;
  frame_->width = size.width;
  frame_->height = size.height;
  check(av_frame_get_buffer(frame_.get(), 0), "picture");
  scaler_.reset(sws_getContext(size.width, size.height, AV_PIX_FMT_BGR24, size.width, size.height, codec_->pix_fmt,
                               SWS_BICUBIC, nullptr, nullptr, nullptr));
  check(!scaler_ ? AVERROR(EINVAL) : 0, "picture");
}

void VideoWriter::write(const cv::Mat& image) {
  check(av_frame_make_writable(frame_.get()), "picture");
  const std::uint8_t* const rows[] = {image.data};
  const int steps[] = {static_cast<int>(image.step)};
  sws_scale(scaler_.get(), rows, steps, 0, image.rows, frame_->data, frame_->linesize);
  frame_->pts = written_++;
  frame_->quality = codec_->global_quality;
  encode(frame_.get());
}

void VideoWriter::encode(const AVFrame* frame) {
  check(avcodec_send_frame(codec_.get(), frame), "encoder");
  for (;;) {
    const int result = avcodec_receive_packet(codec_.get(), packet_.get());
    if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) break;
    check(result, "encoder");
    av_packet_rescale_ts(packet_.get(), codec_->time_base, stream_->time_base);
    packet_->stream_index = stream_->index;
    packet_->duration = av_rescale_q(1, codec_->time_base, stream_->time_base);
    check(av_interleaved_write_frame(format_, packet_.get()), "write");
  }
  check(format_->pb->error, "write");
}

void VideoWriter::close() {
  encode(nullptr);
  check(av_write_trailer(format_), "write");
  avio_flush(format_->pb);
  check(format_->pb->error, "write");
  check(avio_closep(&format_->pb), "close");
}

}  // namespace laparoscope_servo
