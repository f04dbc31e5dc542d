// A second wire format, as unlike the project's own as can be: lines of text, "17 velocity 200 -400 3000 -3300 5000
// *5B21" and so on. The sum is the CRC-16/ARC of the characters before the star.
#pragma once

#include <boost/crc.hpp>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "laparoscope_servo/aesop/codec.h"

namespace laparoscope_servo::aesop {

class LineCodec : public Codec {
 public:
  std::string name() const override { return "lines of text"; }
  std::size_t longestFrame() const override { return 250; }

  Bytes encode(const Frame& frame) override {
    std::ostringstream text;
    text << frame.sequence << ' ';
    std::visit([&](const auto& message) { write(text, message); }, frame.message);
    const std::string line = text.str() + " *" + checkSum(text.str()) + "\n";
    return Bytes(line.begin(), line.end());
  }

  std::vector<Frame> push(const std::uint8_t* data, std::size_t size) override {
    std::vector<Frame> frames;
    for (std::size_t k = 0; k < size; ++k) {
      if (data[k] == '\n') {
        take(frames);
        line_.clear();
      } else if (line_.size() < longestFrame()) {
        line_ += static_cast<char>(data[k]);
      } else {
        ++statistics_.skipped_bytes;
      }
    }
    return frames;
  }

  void reset() override { line_.clear(); }
  const DecoderStatistics& statistics() const override { return statistics_; }

 private:
  static std::string checkSum(const std::string& text) {
    boost::crc_16_type sum;
    sum.process_bytes(text.data(), text.size());
    char digits[8];
    std::snprintf(digits, sizeof digits, "%04X", static_cast<unsigned>(sum.checksum()));
    return digits;
  }
  static long micro(double value) {
    if (!(std::abs(value) <= kLargestNumber)) throw std::invalid_argument("a number is beyond 2000");
    return std::lround(value * 1e6);
  }

  static void write(std::ostream& text, const Identify&) { text << "identify"; }
  static void write(std::ostream& text, const Enable&) { text << "enable"; }
  static void write(std::ostream& text, const Disable&) { text << "disable"; }
  static void write(std::ostream& text, const Stop&) { text << "stop"; }
  static void write(std::ostream& text, const ClearFault&) { text << "clear"; }
  static void write(std::ostream& text, const Poll&) { text << "poll"; }
  static void write(std::ostream& text, const Velocity& velocity) {
    text << "velocity " << std::lround(velocity.time_to_live * 1e3);
    for (const double speed : velocity.speed) text << ' ' << micro(speed);
  }
  static void write(std::ostream& text, const Identity& identity) {
    text << "identity " << int{identity.joints} << ' ' << int{identity.driven} << ' ' << identity.model;
  }
  static void write(std::ostream& text, const Status& status) {
    text << "status " << static_cast<int>(status.state) << ' ' << status.homed << ' ' << status.moving << ' '
         << status.faults << ' ' << status.echo << ' ' << std::llround(status.time * 1e3);
    for (int k = 0; k < kJoints; ++k) text << ' ' << micro(status.position[k]);
    for (int k = 0; k < kJoints; ++k) text << ' ' << micro(status.velocity[k]);
  }

  void take(std::vector<Frame>& frames) {
    const std::size_t star = line_.rfind(" *");
    if (star == std::string::npos || checkSum(line_.substr(0, star)) != line_.substr(star + 2)) {
      ++statistics_.crc_errors;
      statistics_.skipped_bytes += line_.size() + 1;
      return;
    }
    std::istringstream text(line_.substr(0, star));
    Frame frame;
    if (text >> frame.sequence && read(text, frame.message)) {
      ++statistics_.frames;
      frames.push_back(frame);
    } else {
      ++statistics_.malformed;
      statistics_.skipped_bytes += line_.size() + 1;
    }
  }

  static bool read(std::istream& text, Message& message) {
    std::string word;
    text >> word;
    for (const auto& [simple, value] : {std::pair<const char*, Message>{"identify", Identify()},
                                        {"enable", Enable()},
                                        {"disable", Disable()},
                                        {"stop", Stop()},
                                        {"clear", ClearFault()},
                                        {"poll", Poll()}}) {
      if (word != simple) continue;
      message = value;
      return true;
    }
    if (word == "velocity") return readVelocity(text, message);
    if (word == "identity") return readIdentity(text, message);
    return word == "status" && readStatus(text, message);
  }
  static bool readMicro(std::istream& text, double& value) {
    if (!(text >> value)) return false;
    value *= 1e-6;
    return std::abs(value) <= kLargestNumber;
  }
  static bool readVelocity(std::istream& text, Message& message) {
    Velocity velocity;
    if (!(text >> velocity.time_to_live)) return false;
    velocity.time_to_live *= 1e-3;
    for (double& speed : velocity.speed) {
      if (!readMicro(text, speed)) return false;
    }
    message = velocity;
    return true;
  }
  static bool readIdentity(std::istream& text, Message& message) {
    int joints = 0;
    int driven = 0;
    Identity identity;
    if (!(text >> joints >> driven) || !std::getline(text >> std::ws, identity.model)) return false;
    identity.joints = static_cast<std::uint8_t>(joints);
    identity.driven = static_cast<std::uint8_t>(driven);
    message = identity;
    return true;
  }
  static bool readStatus(std::istream& text, Message& message) {
    Status status;
    unsigned state = 0;
    if (!(text >> state >> status.homed >> status.moving >> status.faults >> status.echo >> status.time)) return false;
    if (state > 2) return false;
    status.state = static_cast<RobotState>(state);
    status.time *= 1e-3;
    for (int k = 0; k < kJoints; ++k) {
      if (!readMicro(text, status.position[k])) return false;
    }
    for (int k = 0; k < kJoints; ++k) {
      if (!readMicro(text, status.velocity[k])) return false;
    }
    message = status;
    return true;
  }

  std::string line_;
  DecoderStatistics statistics_;
};

}  // namespace laparoscope_servo::aesop
