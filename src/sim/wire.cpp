#include "laparoscope_servo/sim/wire.h"

#include <algorithm>

namespace laparoscope_servo::sim {

void WireDirection::push(const aesop::Bytes& bytes, const WireFaults& faults, double now) {
  Piece piece{now + faults.delay, {}};
  // A line does not reorder, also when its delay becomes shorter.
  if (!line_.empty()) piece.at = std::max(piece.at, line_.back().at);
  for (std::uint8_t byte : bytes) {
    if (happens(faults.drop)) continue;
    if (happens(faults.corrupt)) byte = static_cast<std::uint8_t>(byte ^ (1u << (random_() % 8)));
    piece.bytes.push_back(byte);
    if (happens(faults.duplicate)) piece.bytes.push_back(byte);
  }
  if (!piece.bytes.empty()) line_.push_back(piece);
}

aesop::Bytes WireDirection::pop(double now) {
  aesop::Bytes bytes;
  while (!line_.empty() && line_.front().at <= now) {
    bytes.insert(bytes.end(), line_.front().bytes.begin(), line_.front().bytes.end());
    line_.pop_front();
  }
  return bytes;
}

std::string Wire::set(const std::string& name, double value, double now) {
  if (name == "none") {
    faults = WireFaults();
    return "";
  }
  if (name == "return") {
    cut_until_ = now;
    return "";
  }
  if (name == "hangup") {
    if (!(value >= 0.0)) return "hangup takes a number of seconds, 0 for ever";
    cut_until_ = value > 0.0 ? now + value : std::numeric_limits<double>::infinity();
    to_controller.clear();
    to_host.clear();
    return "";
  }
  if (name == "delay") {
    if (!(value >= 0.0 && value <= 10.0)) return "delay takes 0 to 10 s";
    faults.delay = value;
    return "";
  }
  double* probability = name == "drop"      ? &faults.drop
                        : name == "corrupt" ? &faults.corrupt
                        : name == "double"  ? &faults.duplicate
                                            : nullptr;
  if (probability == nullptr) return "there is no fault '" + name + "'";
  if (!(value >= 0.0 && value <= 1.0)) return name + " takes a probability from 0 to 1";
  *probability = value;
  return "";
}

}  // namespace laparoscope_servo::sim
