// The wire format a second time, written from doc/aesop_protocol.md alone: no header of the package, tables in place of
// code, the whole stream at once in place of pieces. What the two say of the same bytes has to agree, and what the page
// leaves open shows here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace laparoscope_servo::test_support {

struct PageFrame {
  std::size_t offset = 0;  // in the stream
  std::size_t size = 0;
  unsigned sequence = 0;
  unsigned type = 0;
  std::vector<std::int64_t> fields;  // numbers as on the wire, in the order of the page's tables
  std::string text;                  // of an identity
};

struct PageResult {
  std::vector<PageFrame> frames;
  std::vector<PageFrame> refused;  // CRC right, but not delivered: offset and size only
  std::vector<PageFrame> wrong;    // CRC wrong: offset and size only
  std::size_t skipped = 0;         // bytes, those of refused frames included
  std::size_t malformed = 0;
  std::size_t other_version = 0;
  std::size_t pending = 0;  // bytes at the end that may become a frame
};

class PageDecoder {
 public:
  static PageResult decode(const std::vector<std::uint8_t>& stream) {
    PageResult result;
    std::size_t at = 0;
    const auto skip = [&](std::size_t count) {
      at += count;
      result.skipped += count;
    };
    while (stream.size() - at >= 2) {
      const std::size_t left = stream.size() - at;
      if (stream[at] != 0xA5 || stream[at + 1] != 0x5A) {
        skip(1);
        continue;
      }
      if (left < 7) break;
      const std::size_t n = stream[at + 3];
      if (n > 66) {
        skip(1);
        continue;
      }
      if (left < 9 + n) break;
      PageFrame frame;
      frame.offset = at;
      frame.size = 9 + n;
      if (crc(&stream[at + 2], 5 + n) != number(&stream[at + 7 + n], 2)) {
        result.wrong.push_back(frame);
        skip(1);
        continue;
      }
      const bool version = stream[at + 2] == 1;
      if (version && read(&stream[at], frame)) {
        at += frame.size;
        result.frames.push_back(frame);
      } else {
        ++(version ? result.malformed : result.other_version);
        result.refused.push_back(frame);
        skip(frame.size);
      }
    }
    result.pending = stream.size() - at;
    return result;
  }

  // CRC-16/CCITT-FALSE, bit by bit.
  static unsigned crc(const std::uint8_t* data, std::size_t size) {
    unsigned sum = 0xFFFF;
    for (std::size_t k = 0; k < size; ++k) {
      sum ^= static_cast<unsigned>(data[k]) << 8;
      for (int bit = 0; bit < 8; ++bit) sum = ((sum & 0x8000u) != 0 ? (sum << 1) ^ 0x1021u : sum << 1) & 0xFFFFu;
    }
    return sum;
  }

  // Whether these bytes would be delivered if their CRC were right; their length is that of a frame.
  static bool wouldBeDelivered(const std::uint8_t* frame) {
    PageFrame ignored;
    return frame[2] == 1 && read(frame, ignored);
  }

 private:
  struct Field {
    std::size_t bytes;
    bool is_signed;
    std::int64_t minimum, maximum;
    int count;
  };
  struct Layout {
    unsigned type;
    std::size_t length;
    std::vector<Field> fields;
    std::size_t text;  // characters behind the fields
  };

  static const std::vector<Layout>& layouts() {
    const Field micro4{4, true, -2000000000, 2000000000, 4};
    const Field micro14{4, true, -2000000000, 2000000000, 14};
    static const std::vector<Layout> all = {
        {0x01, 0, {}, 0},
        {0x02, 0, {}, 0},
        {0x03, 0, {}, 0},
        {0x04, 0, {}, 0},
        {0x05, 0, {}, 0},
        {0x06, 0, {}, 0},
        {0x07, 18, {{2, false, 1, 2000, 1}, micro4}, 0},
        {0x81, 18, {{1, false, 0, 255, 2}}, 16},
        {0x82,
         66,
         {{1, false, 0, 2, 1}, {1, false, 0, 3, 1}, {2, false, 0, 65535, 2}, {4, false, 0, 4294967295, 1}, micro14},
         0},
    };
    return all;
  }

  static std::int64_t number(const std::uint8_t* data, std::size_t bytes) {
    std::int64_t value = 0;
    for (std::size_t k = bytes; k-- > 0;) value = value * 256 + data[k];
    return value;
  }

  static bool read(const std::uint8_t* bytes, PageFrame& frame) {
    frame.type = bytes[4];
    frame.sequence = static_cast<unsigned>(number(bytes + 5, 2));
    for (const Layout& layout : layouts()) {
      if (layout.type == frame.type) return bytes[3] == layout.length && read(layout, bytes + 7, frame);
    }
    return false;
  }

  static bool read(const Layout& layout, const std::uint8_t* data, PageFrame& frame) {
    for (const Field& field : layout.fields) {
      for (int k = 0; k < field.count; ++k, data += field.bytes) {
        std::int64_t value = number(data, field.bytes);
        if (field.is_signed && value >= std::int64_t{1} << 31) value -= std::int64_t{1} << 32;
        if (value < field.minimum || value > field.maximum) return false;
        frame.fields.push_back(value);
      }
    }
    bool ended = false;
    for (std::size_t k = 0; k < layout.text; ++k) {
      ended = ended || data[k] == 0;
      if (ended ? data[k] != 0 : data[k] < 0x20 || data[k] > 0x7E) return false;
      if (!ended) frame.text += static_cast<char>(data[k]);
    }
    return true;
  }
};

}  // namespace laparoscope_servo::test_support
