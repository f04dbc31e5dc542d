// How many frames come out of mutated streams that nobody sent, against what a sum of 16 bits lets through: of damage
// that is spread evenly, one comparison in 65,536 finds the sum right by chance.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "support/codec_check.h"
#include "support/stream_mutator.h"

namespace laparoscope_servo::test_support {

struct FalseFrames {
  std::uint64_t streams = 0;
  std::uint64_t bytes = 0;
  std::uint64_t sent = 0;          // frames
  std::uint64_t delivered = 0;     // frames
  std::uint64_t comparisons = 0;   // of a sum with bytes that are no frame that was sent
  std::uint64_t right = 0;         // of those: the sum was right
  std::uint64_t plausible = 0;     // comparisons with bytes that would be delivered if the sum were right
  std::uint64_t false_frames = 0;  // of those: delivered

  FalseFrames& operator+=(const FalseFrames& other) {
    streams += other.streams;
    bytes += other.bytes;
    sent += other.sent;
    delivered += other.delivered;
    comparisons += other.comparisons;
    right += other.right;
    plausible += other.plausible;
    false_frames += other.false_frames;
    return *this;
  }
};

using FalseFramesByKind = std::array<FalseFrames, StreamMutator::kKinds.size()>;

inline bool wasSent(const MutatedStream& stream, const PageFrame& frame) {
  const auto start = stream.bytes.begin() + static_cast<std::ptrdiff_t>(frame.offset);
  return std::any_of(stream.sent.begin(), stream.sent.end(), [&](const aesop::Bytes& sent) {
    return sent.size() == frame.size && std::equal(sent.begin(), sent.end(), start);
  });
}

inline FalseFrames countFalseFrames(const MutatedStream& stream, const PageResult& page) {
  FalseFrames count;
  count.streams = 1;
  count.bytes = stream.bytes.size();
  count.sent = stream.sent.size();
  count.delivered = page.frames.size();
  count.comparisons = page.wrong.size() + page.refused.size();
  count.right = page.refused.size();
  for (const PageFrame& frame : page.wrong) {
    if (PageDecoder::wouldBeDelivered(&stream.bytes[frame.offset])) ++count.plausible;
  }
  for (const PageFrame& frame : page.frames) {
    if (wasSent(stream, frame)) continue;
    ++count.comparisons;
    ++count.right;
    ++count.plausible;
    ++count.false_frames;
  }
  return count;
}

// Of so many streams, each in pieces of random lengths. Stops at the first violation and says what it was.
inline std::string countFalseFrames(std::uint64_t streams, std::uint64_t seed, FalseFramesByKind& counts) {
  StreamMutator mutator(seed);
  for (std::uint64_t k = 0; k < streams; ++k) {
    const MutatedStream stream = mutator.next();
    const Pieces pieces = {1 + mutator.below(90), 1 + mutator.below(20), 1 + mutator.below(5)};
    const PageResult page = PageDecoder::decode(stream.bytes);
    const std::string violation = checkCodec(stream.bytes, pieces, page).violation;
    if (!violation.empty()) return "stream " + std::to_string(k) + ": " + violation;
    counts[stream.kind] += countFalseFrames(stream, page);
  }
  return "";
}

// Probability of `count` or more events where `expected` are expected (Poisson).
inline double chanceOfAtLeast(std::uint64_t count, double expected) {
  double fewer = 0.0;
  for (std::uint64_t k = 0; k < count; ++k) {
    const auto n = static_cast<double>(k);
    fewer += std::exp(n * std::log(expected) - expected - std::lgamma(n + 1.0));
  }
  return std::max(0.0, 1.0 - fewer);
}

constexpr double kSumsByChance = 1.0 / 65536.0;
constexpr double kTooUnlikely = 1e-6;

// More sums right, or more frames delivered that were not sent, than chance explains; empty when there are not.
inline std::string beyondChance(const FalseFrames& count) {
  const double right = static_cast<double>(count.comparisons) * kSumsByChance;
  const double delivered = static_cast<double>(count.plausible) * kSumsByChance;
  if (count.right > 0 && chanceOfAtLeast(count.right, right) < kTooUnlikely) {
    return std::to_string(count.right) + " sums are right by chance, " + std::to_string(right) + " were expected";
  }
  if (count.false_frames > 0 && chanceOfAtLeast(count.false_frames, delivered) < kTooUnlikely) {
    return std::to_string(count.false_frames) + " false frames, " + std::to_string(delivered) + " were expected";
  }
  return "";
}

}  // namespace laparoscope_servo::test_support
