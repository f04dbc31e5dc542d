// Videos as recorders write them, also odd ones, through libav: what OpenCV's writer cannot do.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libavutil/log.h>
#include <libavutil/mem.h>
#include <libswscale/swscale.h>
}

#include <cstdint>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace laparoscope_servo::test_support {

struct TestVideo {
  std::string codec = "mpeg4";  // libav's name of the encoder
  AVPixelFormat pixels = AV_PIX_FMT_YUV420P;
  AVRational time_base{1, 1000};  // s, of `times`
  AVRational rate{25, 1};
  int group = 12;         // pictures from one key picture to the next
  int between = 0;        // pictures that rest on later ones, in a row
  int degrees = 0;        // clockwise, that a player turns it by
  bool mirrored = false;  // left and right, before it is turned
  AVRational pixel_aspect{0, 1};
  AVColorSpace matrix = AVCOL_SPC_UNSPECIFIED;
  AVColorRange range = AVCOL_RANGE_UNSPECIFIED;
  bool index_first = false;         // of an MP4, in front of the pictures
  std::vector<std::int64_t> times;  // of each picture; empty: 40 ms apart
};

inline bool canEncode(const std::string& codec) {
  return avcodec_find_encoder_by_name(codec.c_str()) != nullptr;
}

inline void check(int result) {
  if (result < 0) throw std::runtime_error("libav: " + std::to_string(result));
}

// The container by the ending of `path`. The pictures are all of one size, CV_8UC3.
inline void writeVideo(const std::string& path, const std::vector<cv::Mat>& pictures, const TestVideo& video = {}) {
  av_log_set_level(AV_LOG_FATAL);
  AVFormatContext* format = nullptr;
  check(avformat_alloc_output_context2(&format, nullptr, nullptr, path.c_str()));
  const AVCodec* encoder = avcodec_find_encoder_by_name(video.codec.c_str());
  AVCodecContext* codec = avcodec_alloc_context3(encoder);
  const int width = pictures.front().cols;
  const int height = pictures.front().rows;
  codec->width = width;
  codec->height = height;
  codec->pix_fmt = video.pixels;
  codec->time_base = video.time_base;
  codec->framerate = video.rate;
  codec->gop_size = video.group;
  codec->max_b_frames = video.between;
  codec->sample_aspect_ratio = video.pixel_aspect;
  codec->colorspace = video.matrix;
  codec->color_range = video.range;
  codec->flags |= AV_CODEC_FLAG_QSCALE;
  codec->global_quality = 2 * FF_QP2LAMBDA;
  codec->strict_std_compliance = FF_COMPLIANCE_UNOFFICIAL;
  codec->level = video.codec == "ffv1" ? 3 : FF_LEVEL_UNKNOWN;  // with check sums
  if ((format->oformat->flags & AVFMT_GLOBALHEADER) != 0) codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  check(avcodec_open2(codec, encoder, nullptr));
  AVStream* stream = avformat_new_stream(format, nullptr);
  check(avcodec_parameters_from_context(stream->codecpar, codec));
  stream->time_base = video.time_base;
  stream->avg_frame_rate = video.rate;
  stream->sample_aspect_ratio = video.pixel_aspect;
  if (video.degrees != 0 || video.mirrored) {
    auto* matrix = static_cast<std::int32_t*>(av_malloc(9 * sizeof(std::int32_t)));
    av_display_rotation_set(matrix, video.degrees);
    if (video.mirrored) av_display_matrix_flip(matrix, 1, 0);
    check(av_stream_add_side_data(stream, AV_PKT_DATA_DISPLAYMATRIX, reinterpret_cast<std::uint8_t*>(matrix),
                                  9 * sizeof(std::int32_t)));
  }
  check(avio_open(&format->pb, ("file:" + path).c_str(), AVIO_FLAG_WRITE));
  AVDictionary* options = nullptr;
  if (video.index_first) av_dict_set(&options, "movflags", "faststart", 0);
  check(avformat_write_header(format, &options));
  av_dict_free(&options);

  AVFrame* frame = av_frame_alloc();
  frame->format = codec->pix_fmt;
  frame->width = width;
  frame->height = height;
  frame->quality = codec->global_quality;
  check(av_frame_get_buffer(frame, 0));
  SwsContext* scaler = sws_getContext(width, height, AV_PIX_FMT_BGR24, width, height, codec->pix_fmt,
                                      SWS_BICUBIC | SWS_ACCURATE_RND, nullptr, nullptr, nullptr);
  const bool full = video.range == AVCOL_RANGE_JPEG || video.pixels == AV_PIX_FMT_YUVJ420P;
  if (full || video.matrix == AVCOL_SPC_BT709) {
    int* from = nullptr;
    int* to = nullptr;
    int from_full = 0;
    int to_full = 0;
    int brightness = 0;
    int contrast = 0;
    int saturation = 0;
    sws_getColorspaceDetails(scaler, &from, &from_full, &to, &to_full, &brightness, &contrast, &saturation);
    const int* table = video.matrix == AVCOL_SPC_BT709 ? sws_getCoefficients(SWS_CS_ITU709) : to;
    sws_setColorspaceDetails(scaler, from, from_full, table, full ? 1 : 0, brightness, contrast, saturation);
  }
  AVPacket* packet = av_packet_alloc();
  for (std::size_t k = 0; k <= pictures.size(); ++k) {
    if (k < pictures.size()) {
      check(av_frame_make_writable(frame));
      const cv::Mat& picture = pictures[k];
      const std::uint8_t* const rows[] = {picture.data};
      const int steps[] = {static_cast<int>(picture.step)};
      sws_scale(scaler, rows, steps, 0, height, frame->data, frame->linesize);
      frame->pts = video.times.empty() ? 40 * static_cast<std::int64_t>(k) : video.times[k];
    }
    check(avcodec_send_frame(codec, k < pictures.size() ? frame : nullptr));
    while (avcodec_receive_packet(codec, packet) == 0) {
      packet->stream_index = 0;
      av_packet_rescale_ts(packet, video.time_base, stream->time_base);
      check(av_interleaved_write_frame(format, packet));
    }
  }
  check(av_write_trailer(format));
  avio_closep(&format->pb);
  avformat_free_context(format);
  avcodec_free_context(&codec);
  av_packet_free(&packet);
  av_frame_free(&frame);
  sws_freeContext(scaler);
}

inline std::string bytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Writes into an AVI's header that its first stream is `units` of time long.
inline void setAviLength(const std::string& path, std::int32_t units) {
  const std::size_t header = bytesOf(path).find("strh");
  if (header == std::string::npos) throw std::runtime_error(path + " is no AVI");
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(static_cast<std::streamoff>(header) + 40);  // dwLength
  for (int shift = 0; shift < 32; shift += 8) file.put(static_cast<char>(units >> shift & 0xff));
}

inline void writeBytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

// Where the packets of the video's pictures lie in the file.
struct Place {
  std::size_t at = 0;
  std::size_t size = 0;
};
inline std::vector<Place> packetsOf(const std::string& path) {
  AVFormatContext* format = nullptr;
  check(avformat_open_input(&format, ("file:" + path).c_str(), nullptr, nullptr));
  check(avformat_find_stream_info(format, nullptr));
  std::vector<Place> places;
  AVPacket* packet = av_packet_alloc();
  for (; av_read_frame(format, packet) == 0; av_packet_unref(packet)) {
    places.push_back({static_cast<std::size_t>(packet->pos), static_cast<std::size_t>(packet->size)});
  }
  av_packet_free(&packet);
  avformat_close_input(&format);
  return places;
}

}  // namespace laparoscope_servo::test_support
