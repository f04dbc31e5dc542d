// Shared by the sources that use libav: owners of its objects, and texts of its errors. Uses only the API common to
// ffmpeg 4.2 (Ubuntu 20.04) and 5.1 (Debian 12).
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/dict.h>
#include <libavutil/display.h>
#include <libavutil/log.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

#include <array>
#include <cstdint>
#include <memory>
#include <string>

namespace laparoscope_servo::libav {

struct Free {
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};
using Frame = std::unique_ptr<AVFrame, Free>;
using Packet = std::unique_ptr<AVPacket, Free>;
using Codec = std::unique_ptr<AVCodecContext, Free>;
using Scaler = std::unique_ptr<SwsContext, Free>;

inline std::string errorText(int code) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  return av_strerror(code, text.data(), text.size()) == 0 ? text.data() : "error " + std::to_string(code);
}

// A name such as 10:00:00.mp4 is a file, not an address.
inline std::string fileUrl(const std::string& path) {
  return "file:" + path;
}

// 0: not known.
inline double toDouble(AVRational value) {
  return value.num > 0 && value.den > 0 ? av_q2d(value) : 0.0;
}

inline double seconds(std::int64_t time, AVRational base) {
  return static_cast<double>(time) * base.num / base.den;
}

}  // namespace laparoscope_servo::libav
