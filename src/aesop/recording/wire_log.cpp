#include "laparoscope_servo/aesop/wire_log.h"

#include <algorithm>
#include <cstring>

namespace laparoscope_servo::aesop {

namespace {

constexpr char kMagic[] = {'L', 'S', '-', 'W', 'I', 'R', 'E', '\n'};
constexpr std::uint16_t kVersion = 1;
constexpr std::size_t kLargestPayload = 65536;
constexpr std::size_t kLargestName = 255;

void append(std::uint64_t value, std::size_t size, Bytes& bytes) {
  for (std::size_t k = 0; k < size; ++k) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
}

std::uint64_t number(const std::uint8_t* data, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t k = 0; k < size; ++k) value |= static_cast<std::uint64_t>(data[k]) << (8 * k);
  return value;
}

// Seven bits a byte, the lowest first; the highest bit says that another byte follows.
void appendVarint(std::uint64_t value, Bytes& bytes) {
  while (value >= 0x80) {
    bytes.push_back(static_cast<std::uint8_t>(value | 0x80));
    value >>= 7;
  }
  bytes.push_back(static_cast<std::uint8_t>(value));
}

}  // namespace

Bytes payloadOf(std::initializer_list<double> numbers) {
  Bytes bytes;
  for (const double value : numbers) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    append(bits, sizeof bits, bytes);
  }
  return bytes;
}

Bytes payloadOf(const std::string& text) {
  return Bytes(text.begin(), text.end());
}

std::vector<double> numbersOf(const WireRecord& record, std::size_t count) {
  if (record.payload.size() != 8 * count) {
    throw std::invalid_argument("a record of " + std::to_string(record.payload.size()) + " bytes, expected " +
                                std::to_string(count) + " numbers");
  }
  std::vector<double> numbers(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint64_t bits = number(&record.payload[8 * k], 8);
    std::memcpy(&numbers[k], &bits, sizeof bits);
  }
  return numbers;
}

std::string textOf(const WireRecord& record) {
  return std::string(record.payload.begin(), record.payload.end());
}

void WireLogEncoder::begin(const WireLogHeader& header, Bytes& bytes) {
  bytes.insert(bytes.end(), std::begin(kMagic), std::end(kMagic));
  append(kVersion, 2, bytes);
  append(static_cast<std::uint64_t>(header.wall_time), 8, bytes);
  append(static_cast<std::uint64_t>(header.time), 8, bytes);
  const std::string name = header.codec.substr(0, kLargestName);
  append(name.size(), 1, bytes);
  bytes.insert(bytes.end(), name.begin(), name.end());
  time_ = header.time;
}

void WireLogEncoder::add(const WireRecord& record, Bytes& bytes) {
  const std::size_t size = std::min(record.payload.size(), kLargestPayload);
  bytes.push_back(static_cast<std::uint8_t>(record.event));
  appendVarint(static_cast<std::uint64_t>(std::max<std::int64_t>(record.time - time_, 0)), bytes);
  appendVarint(size, bytes);
  bytes.insert(bytes.end(), record.payload.begin(), record.payload.begin() + static_cast<std::ptrdiff_t>(size));
  time_ = std::max(time_, record.time);
}

WireLogReader::WireLogReader(std::istream& stream) : stream_(stream) {
  Bytes bytes;
  if (!read(bytes, sizeof kMagic) || !std::equal(bytes.begin(), bytes.end(), kMagic)) fail("this is no wire log");
  if (!read(bytes, 2)) fail("the header breaks off");
  if (number(bytes.data(), 2) != kVersion) {
    fail("version " + std::to_string(number(bytes.data(), 2)) + ", expected " + std::to_string(kVersion));
  }
  if (!read(bytes, 17)) fail("the header breaks off");
  header_.wall_time = static_cast<std::int64_t>(number(bytes.data(), 8));
  header_.time = static_cast<std::int64_t>(number(bytes.data() + 8, 8));
  if (!read(bytes, bytes[16])) fail("the header breaks off");
  header_.codec.assign(bytes.begin(), bytes.end());
  time_ = header_.time;
}

std::optional<WireRecord> WireLogReader::next() {
  const std::optional<std::uint8_t> event = byte();
  if (!event) return std::nullopt;
  if (*event < static_cast<std::uint8_t>(WireEvent::kOpened) ||
      *event > static_cast<std::uint8_t>(WireEvent::kInsertionPoint)) {
    fail("event " + std::to_string(*event) + ", expected 1 to 12");
  }
  truncated_ = true;  // set to false when the record is complete
  const std::optional<std::uint64_t> pause = varint();
  const std::optional<std::uint64_t> size = varint();
  if (!pause || !size) return std::nullopt;
  if (*pause > static_cast<std::uint64_t>(INT64_MAX - std::max<std::int64_t>(time_, 0)))
    fail("a time beyond all times");
  if (*size > kLargestPayload) fail("a record of " + std::to_string(*size) + " bytes, expected 0 to 65536");
  WireRecord record;
  record.event = static_cast<WireEvent>(*event);
  if (!read(record.payload, static_cast<std::size_t>(*size))) return std::nullopt;
  time_ += static_cast<std::int64_t>(*pause);
  record.time = time_;
  truncated_ = false;
  return record;
}

std::optional<std::uint8_t> WireLogReader::byte() {
  const int value = stream_.get();
  if (value == std::istream::traits_type::eof()) return std::nullopt;
  ++offset_;
  return static_cast<std::uint8_t>(value);
}

std::optional<std::uint64_t> WireLogReader::varint() {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 63; shift += 7) {
    const std::optional<std::uint8_t> next = byte();
    if (!next) return std::nullopt;
    value |= static_cast<std::uint64_t>(*next & 0x7F) << shift;
    if ((*next & 0x80) == 0) return value;
  }
  fail("a number of more than 63 bits");
}

bool WireLogReader::read(Bytes& bytes, std::size_t size) {
  bytes.resize(size);
  stream_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  offset_ += static_cast<std::uint64_t>(stream_.gcount());
  return stream_.gcount() == static_cast<std::streamsize>(size);
}

void WireLogReader::fail(const std::string& what) const {
  throw WireLogError("byte " + std::to_string(offset_) + ": " + what);
}

}  // namespace laparoscope_servo::aesop
