#include "aesop/protocol/own_codec.h"

#include <algorithm>
#include <boost/crc.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace laparoscope_servo::aesop {

namespace {

constexpr std::uint8_t kMarker[2] = {0xA5, 0x5A};
constexpr std::size_t kHeader = 7;  // marker, version, length, type, sequence
constexpr std::size_t kModelLength = 16;
constexpr double kMicro = 1e6;
constexpr double kMilli = 1e3;
constexpr double kLongestTimeToLive = 2.0;  // s

enum Type : std::uint8_t {
  kIdentify = 0x01,
  kEnable = 0x02,
  kDisable = 0x03,
  kStop = 0x04,
  kClearFault = 0x05,
  kPoll = 0x06,
  kVelocity = 0x07,
  kIdentity = 0x81,
  kStatus = 0x82,
};

constexpr std::size_t kVelocityLength = 2 + 4 * kDrivenJoints;
constexpr std::size_t kIdentityLength = 2 + kModelLength;
constexpr std::size_t kStatusLength = 10 + 8 * kJoints;
static_assert(kStatusLength == kLargestPayload, "the status is the largest payload");

std::uint16_t crc(const std::uint8_t* data, std::size_t size) {
  boost::crc_ccitt_type sum;  // polynomial 0x1021, starts at 0xFFFF, nothing reflected
  sum.process_bytes(data, size);
  return static_cast<std::uint16_t>(sum.checksum());
}

[[noreturn]] void refuse(const std::string& field, double value, const std::string& expected) {
  std::ostringstream text;
  text << field << " = " << value << ", expected " << expected;
  throw std::invalid_argument(text.str());
}

class Writer {
 public:
  void u8(std::uint8_t value) { bytes_.push_back(value); }
  void u16(std::uint16_t value) {
    u8(static_cast<std::uint8_t>(value & 0xFF));
    u8(static_cast<std::uint8_t>(value >> 8));
  }
  void u32(std::uint32_t value) {
    u16(static_cast<std::uint16_t>(value & 0xFFFF));
    u16(static_cast<std::uint16_t>(value >> 16));
  }
  // In millionths.
  void micro(const std::string& field, double value) {
    if (!(std::abs(value) <= kLargestNumber)) refuse(field, value, "a number from -2000 to 2000");
    u32(static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value * kMicro))));
  }
  const Bytes& bytes() const { return bytes_; }

 private:
  Bytes bytes_;
};

// Reads a payload whose length has been checked; it still refuses to read beyond the end.
class Reader {
 public:
  Reader(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  std::uint8_t u8() {
    if (at_ >= size_) throw std::out_of_range("read past the end of a payload");
    return data_[at_++];
  }
  std::uint16_t u16() {
    const std::uint16_t low = u8();
    return static_cast<std::uint16_t>(low | (u8() << 8));
  }
  std::uint32_t u32() {
    const std::uint32_t low = u16();
    return low | (static_cast<std::uint32_t>(u16()) << 16);
  }
  // In millionths; a value out of range makes the payload malformed.
  double micro() {
    const double value = static_cast<std::int32_t>(u32()) / kMicro;
    in_range_ = in_range_ && std::abs(value) <= kLargestNumber;
    return value;
  }
  bool isInRange() const { return in_range_; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
  bool in_range_ = true;
};

struct PayloadWriter {
  Writer& writer;

  Type operator()(const Identify&) { return kIdentify; }
  Type operator()(const Enable&) { return kEnable; }
  Type operator()(const Disable&) { return kDisable; }
  Type operator()(const Stop&) { return kStop; }
  Type operator()(const ClearFault&) { return kClearFault; }
  Type operator()(const Poll&) { return kPoll; }

  Type operator()(const Velocity& velocity) {
    const double ttl = velocity.time_to_live;
    if (!(ttl >= 0.001 && ttl <= kLongestTimeToLive)) refuse("time_to_live", ttl, "from 0.001 to 2 s");
    writer.u16(static_cast<std::uint16_t>(std::lround(ttl * kMilli)));
    for (const double speed : velocity.speed) writer.micro("speed", speed);
    return kVelocity;
  }

  Type operator()(const Identity& identity) {
    const auto printable = [](char c) { return c >= 0x20 && c <= 0x7E; };
    if (identity.model.size() > kModelLength || !std::all_of(identity.model.begin(), identity.model.end(), printable)) {
      throw std::invalid_argument("model = '" + identity.model + "', expected at most 16 printable ASCII characters");
    }
    writer.u8(identity.joints);
    writer.u8(identity.driven);
    for (std::size_t k = 0; k < kModelLength; ++k) {
      writer.u8(k < identity.model.size() ? static_cast<std::uint8_t>(identity.model[k]) : 0);
    }
    return kIdentity;
  }

  Type operator()(const Status& status) {
    if (!(status.time >= 0.0 && status.time < 1e15)) refuse("time", status.time, "from 0 to 1e15 s");
    writer.u8(static_cast<std::uint8_t>(status.state));
    writer.u8(static_cast<std::uint8_t>((status.homed ? 1 : 0) | (status.moving ? 2 : 0)));
    writer.u16(status.faults);
    writer.u16(status.echo);
    writer.u32(static_cast<std::uint32_t>(static_cast<std::uint64_t>(status.time * kMilli + 0.5)));
    for (int k = 0; k < kJoints; ++k) writer.micro("position", status.position[k]);
    for (int k = 0; k < kJoints; ++k) writer.micro("velocity", status.velocity[k]);
    return kStatus;
  }
};

std::optional<Message> readVelocity(Reader& reader) {
  Velocity velocity;
  velocity.time_to_live = reader.u16() / kMilli;
  if (!(velocity.time_to_live >= 0.001 && velocity.time_to_live <= kLongestTimeToLive)) return std::nullopt;
  for (double& speed : velocity.speed) speed = reader.micro();
  return velocity;
}

std::optional<Message> readIdentity(Reader& reader) {
  Identity identity;
  identity.joints = reader.u8();
  identity.driven = reader.u8();
  bool ended = false;
  for (std::size_t k = 0; k < kModelLength; ++k) {
    const std::uint8_t c = reader.u8();
    ended = ended || c == 0;
    if (ended ? c != 0 : (c < 0x20 || c > 0x7E)) return std::nullopt;
    if (!ended) identity.model += static_cast<char>(c);
  }
  return identity;
}

std::optional<Message> readStatus(Reader& reader) {
  Status status;
  const std::uint8_t state = reader.u8();
  const std::uint8_t flags = reader.u8();
  if (state > static_cast<std::uint8_t>(RobotState::kFault) || (flags & ~3u) != 0) return std::nullopt;
  status.state = static_cast<RobotState>(state);
  status.homed = (flags & 1u) != 0;
  status.moving = (flags & 2u) != 0;
  status.faults = reader.u16();
  status.echo = reader.u16();
  status.time = reader.u32() / kMilli;
  for (int k = 0; k < kJoints; ++k) status.position[k] = reader.micro();
  for (int k = 0; k < kJoints; ++k) status.velocity[k] = reader.micro();
  return status;
}

std::optional<Message> readMessage(std::uint8_t type, Reader& reader, std::size_t size) {
  switch (type) {
    case kIdentify:
      return size == 0 ? std::optional<Message>(Identify()) : std::nullopt;
    case kEnable:
      return size == 0 ? std::optional<Message>(Enable()) : std::nullopt;
    case kDisable:
      return size == 0 ? std::optional<Message>(Disable()) : std::nullopt;
    case kStop:
      return size == 0 ? std::optional<Message>(Stop()) : std::nullopt;
    case kClearFault:
      return size == 0 ? std::optional<Message>(ClearFault()) : std::nullopt;
    case kPoll:
      return size == 0 ? std::optional<Message>(Poll()) : std::nullopt;
    case kVelocity:
      return size == kVelocityLength ? readVelocity(reader) : std::nullopt;
    case kIdentity:
      return size == kIdentityLength ? readIdentity(reader) : std::nullopt;
    case kStatus:
      return size == kStatusLength ? readStatus(reader) : std::nullopt;
    default:
      return std::nullopt;
  }
}

std::optional<Message> readPayload(std::uint8_t type, const std::uint8_t* data, std::size_t size) {
  Reader reader(data, size);
  const std::optional<Message> message = readMessage(type, reader, size);
  return reader.isInRange() ? message : std::nullopt;
}

}  // namespace

Bytes encode(const Frame& frame) {
  Writer payload;
  const Type type = std::visit(PayloadWriter{payload}, frame.message);
  Writer writer;
  writer.u8(kMarker[0]);
  writer.u8(kMarker[1]);
  writer.u8(kProtocolVersion);
  writer.u8(static_cast<std::uint8_t>(payload.bytes().size()));
  writer.u8(type);
  writer.u16(frame.sequence);
  for (const std::uint8_t byte : payload.bytes()) writer.u8(byte);
  const Bytes& bytes = writer.bytes();
  writer.u16(crc(bytes.data() + 2, bytes.size() - 2));
  return writer.bytes();
}

std::vector<Frame> Decoder::push(const std::uint8_t* data, std::size_t size) {
  buffer_.insert(buffer_.end(), data, data + size);
  std::vector<Frame> frames;
  std::size_t at = 0;
  const auto skip = [&](std::size_t count) {
    at += count;
    statistics_.skipped_bytes += count;
  };
  while (buffer_.size() - at >= 2) {
    const std::uint8_t* start = buffer_.data() + at;
    if (start[0] != kMarker[0] || start[1] != kMarker[1]) {
      skip(1);
      continue;
    }
    if (buffer_.size() - at < kHeader) break;
    const std::size_t payload = start[3];
    // An impossible length is refused at once; otherwise a corrupted byte would swallow the good frames behind it.
    if (payload > kLargestPayload) {
      skip(1);
      continue;
    }
    const std::size_t total = payload + kFrameOverhead;
    if (buffer_.size() - at < total) break;
    const auto sum = static_cast<std::uint16_t>(start[total - 2] | (start[total - 1] << 8));
    if (crc(start + 2, total - 4) != sum) {
      ++statistics_.crc_errors;
      skip(1);  // not the whole frame, since its length may be wrong
      continue;
    }
    if (deliver(start, frames)) {
      at += total;
    } else {
      skip(total);
    }
  }
  // Keeps the rest, which is at most the beginning of one frame.
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(at));
  return frames;
}

bool Decoder::deliver(const std::uint8_t* start, std::vector<Frame>& frames) {
  if (start[2] != kProtocolVersion) {
    ++statistics_.other_version;
    statistics_.version_heard = start[2];
    return false;
  }
  const std::optional<Message> message = readPayload(start[4], start + kHeader, start[3]);
  if (!message) {
    ++statistics_.malformed;
    return false;
  }
  ++statistics_.frames;
  frames.push_back({static_cast<std::uint16_t>(start[5] | (start[6] << 8)), *message});
  return true;
}

std::string OwnCodec::name() const {
  return "laparoscope_servo version " + std::to_string(kProtocolVersion);
}

std::unique_ptr<Codec> makeOwnCodec() {
  return std::make_unique<OwnCodec>();
}

}  // namespace laparoscope_servo::aesop
