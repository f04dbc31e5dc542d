// Streams of good frames, and what bad lines could make of them. The same seed gives the same streams. A last frame is
// left whole, so that what the damage pretends to be comes to an end.
#pragma once

#include <algorithm>
#include <array>
#include <random>
#include <utility>
#include <vector>

#include "aesop/protocol/own_codec.h"

namespace laparoscope_servo::test_support {

struct MutatedStream {
  std::vector<aesop::Bytes> sent;
  aesop::Bytes bytes;
  std::size_t kind = 0;  // index into StreamMutator::kKinds
};

class StreamMutator {
 public:
  static constexpr std::array<const char*, 10> kKinds = {
      "flip bits",  "change bytes", "drop bytes", "double bytes",   "insert",
      "zero bytes", "move a part",  "cut off",    "forge a header", "all mixed"};

  explicit StreamMutator(std::uint64_t seed) : random_(seed) {}

  MutatedStream next() {
    MutatedStream stream;
    const std::size_t count = 1 + below(4);
    for (std::size_t k = 0; k < count; ++k) {
      stream.sent.push_back(aesop::encode({static_cast<std::uint16_t>(random_()), message()}));
      stream.bytes.insert(stream.bytes.end(), stream.sent.back().begin(), stream.sent.back().end());
    }
    stream.kind = below(kKinds.size());
    const std::size_t mutations = 1 + below(4);
    for (std::size_t k = 0; k < mutations && !stream.bytes.empty(); ++k) {
      mutate(stream.bytes, stream.kind + 1 == kKinds.size() ? below(kKinds.size() - 1) : stream.kind);
    }
    stream.sent.push_back(aesop::encode({static_cast<std::uint16_t>(random_()), status()}));
    stream.bytes.insert(stream.bytes.end(), stream.sent.back().begin(), stream.sent.back().end());
    return stream;
  }

  // A message with values from all of their ranges, the ends and zero more often.
  aesop::Message message() {
    switch (below(9)) {
      case 0:
        return aesop::Identify();
      case 1:
        return aesop::Enable();
      case 2:
        return aesop::Disable();
      case 3:
        return aesop::Stop();
      case 4:
        return aesop::ClearFault();
      case 5:
        return aesop::Poll();
      case 6:
        return velocity();
      case 7:
        return identity();
      default:
        return status();
    }
  }

  std::size_t below(std::size_t end) { return static_cast<std::size_t>(random_() % end); }

 private:
  using Offset = std::ptrdiff_t;

  double number() {
    switch (below(8)) {
      case 0:
        return 0.0;
      case 1:
        return aesop::kLargestNumber;
      case 2:
        return -aesop::kLargestNumber;
      case 3:
        return (static_cast<double>(below(4000000001)) - 2e9) * 1e-6;
      default:
        return (static_cast<double>(below(2000001)) - 1e6) * 1e-6;
    }
  }
  aesop::Message velocity() {
    aesop::Velocity velocity;
    velocity.time_to_live = static_cast<double>(1 + below(2000)) * 1e-3;
    for (double& speed : velocity.speed) speed = number();
    return velocity;
  }
  aesop::Message identity() {
    aesop::Identity identity;
    identity.joints = static_cast<std::uint8_t>(random_());
    identity.driven = static_cast<std::uint8_t>(random_());
    identity.model.resize(below(17));
    for (char& c : identity.model) c = static_cast<char>(0x20 + below(0x5F));
    return identity;
  }
  aesop::Message status() {
    aesop::Status status;
    status.state = static_cast<aesop::RobotState>(below(3));
    status.homed = below(2) == 0;
    status.moving = below(2) == 0;
    status.faults = below(2) == 0 ? std::uint16_t{0} : static_cast<std::uint16_t>(random_());
    status.echo = static_cast<std::uint16_t>(random_());
    status.time = static_cast<double>(below(4294967296)) * 1e-3;
    for (int k = 0; k < aesop::kJoints; ++k) status.position[k] = number();
    for (int k = 0; k < aesop::kJoints; ++k) status.velocity[k] = number();
    return status;
  }

  // A run of at most `longest` bytes within `bytes`, never empty.
  std::pair<Offset, Offset> part(const aesop::Bytes& bytes, std::size_t longest) {
    const std::size_t from = below(bytes.size());
    const std::size_t size = 1 + below(std::min(longest, bytes.size() - from));
    return {static_cast<Offset>(from), static_cast<Offset>(from + size)};
  }

  void mutate(aesop::Bytes& bytes, std::size_t kind) {
    const auto [from, to] = part(bytes, 4);
    const auto begin = bytes.begin();
    switch (kind) {
      case 0:
        bytes[static_cast<std::size_t>(from)] ^= static_cast<std::uint8_t>(1u << below(8));
        break;
      case 1:
        for (Offset k = from; k < to; ++k) bytes[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(random_());
        break;
      case 2:
        bytes.erase(begin + from, begin + to);
        break;
      case 3: {
        const aesop::Bytes copy(begin + from, begin + to);
        bytes.insert(begin + to, copy.begin(), copy.end());
        break;
      }
      case 4: {
        aesop::Bytes noise(1 + below(12));
        for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random_());
        bytes.insert(begin + from, noise.begin(), noise.end());
        break;
      }
      case 5:
        std::fill(begin + from, begin + to, std::uint8_t{0});
        break;
      case 6: {
        const auto [first, last] = part(bytes, 80);
        const aesop::Bytes moved(begin + first, begin + last);
        bytes.erase(begin + first, begin + last);
        bytes.insert(bytes.begin() + static_cast<Offset>(below(bytes.size() + 1)), moved.begin(), moved.end());
        break;
      }
      case 7:
        if (below(2) == 0) {
          bytes.resize(static_cast<std::size_t>(from));
        } else {
          bytes.erase(begin, begin + to);
        }
        break;
      default:
        forge(bytes, static_cast<std::size_t>(from));
    }
  }

  // A header that promises a frame of some type and its length, over whatever is there.
  void forge(aesop::Bytes& bytes, std::size_t at) {
    static constexpr std::array<std::array<std::uint8_t, 2>, 4> kLengthAndType = {
        {{0, 0x02}, {18, 0x07}, {18, 0x81}, {66, 0x82}}};
    const auto [length, type] = kLengthAndType[below(kLengthAndType.size())];
    const std::uint8_t header[] = {0xA5, 0x5A, 1, length, type};
    for (std::size_t k = 0; k < sizeof header && at + k < bytes.size(); ++k) bytes[at + k] = header[k];
  }

  std::mt19937_64 random_;
};

}  // namespace laparoscope_servo::test_support
