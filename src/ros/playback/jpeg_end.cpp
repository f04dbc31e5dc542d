#include "ros/playback/jpeg_end.h"

#include <cstddef>

namespace laparoscope_servo {

namespace {

constexpr unsigned char kStart = 0xD8;
constexpr unsigned char kEnd = 0xD9;
constexpr unsigned char kFirstWithoutLength = 0xD0;  // RST0 to RST7, SOI, EOI; and TEM
constexpr unsigned char kTem = 0x01;

unsigned char at(const std::string& bytes, std::size_t k) {
  return static_cast<unsigned char>(bytes[k]);
}

bool hasLength(unsigned char marker) {
  return marker != kTem && !(marker >= kFirstWithoutLength && marker <= kEnd);
}

}  // namespace

bool isJpeg(const std::string& bytes) {
  return bytes.size() > 2 && at(bytes, 0) == 0xFF && at(bytes, 1) == kStart && at(bytes, 2) == 0xFF;
}

bool hasJpegEnd(const std::string& bytes) {
  for (std::size_t k = 2; k + 1 < bytes.size();) {
    const unsigned char marker = at(bytes, k + 1);
    if (at(bytes, k) != 0xFF || marker == 0x00 || marker == 0xFF) {  // data of a scan, or fill bytes
      ++k;
      continue;
    }
    if (marker == kEnd) return true;
    k += 2;
    // Skips a header with its contents; the data of a scan follow without a length.
    if (hasLength(marker) && k + 1 < bytes.size()) k += 256U * at(bytes, k) + at(bytes, k + 1);
  }
  return false;
}

}  // namespace laparoscope_servo
