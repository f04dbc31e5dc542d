#include "laparoscope_servo/sim/wire.h"

#include <algorithm>

namespace laparoscope_servo::sim {

namespace {

constexpr std::size_t kBuffer = 4096;  // bytes, as of a serial driver
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

void WireDirection::push(const aesop::Bytes& bytes, double now) {
  for (std::uint8_t byte : bytes) {
    if (line_.size() >= kBuffer) return;
    sent_until_ = std::max(sent_until_, now) + byte_time_;
    if (happens(faults.drop)) continue;
    if (happens(faults.corrupt)) byte = static_cast<std::uint8_t>(byte ^ (1u << (random_() % 8)));
    carry(byte, sent_until_);
    if (!happens(faults.duplicate)) continue;
    sent_until_ += byte_time_;
    carry(byte, sent_until_);
  }
}

void WireDirection::carry(std::uint8_t byte, double now) {
  // A line keeps the order of bytes, also when its delay becomes shorter.
  const double at = now + faults.delay;
  line_.push_back({line_.empty() ? at : std::max(at, line_.back().at), byte});
}

aesop::Bytes WireDirection::pop(double now) {
  aesop::Bytes bytes;
  if (now < faults.stalled_until) return bytes;
  while (!line_.empty() && line_.front().at <= now) {
    bytes.push_back(line_.front().value);
    line_.pop_front();
  }
  return bytes;
}

double WireDirection::next() const {
  return line_.empty() ? kInfinity : std::max(line_.front().at, faults.stalled_until);
}

void Wire::cut(double until) {
  cut_until_ = until;
  to_controller.clear();
  to_host.clear();
}

}  // namespace laparoscope_servo::sim
