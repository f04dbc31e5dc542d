// What the decoder has to keep, whatever the bytes: used by the fuzz target, by the mutated streams and by the unit
// tests.
#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "aesop/protocol/own_codec.h"
#include "support/page_decoder.h"

namespace laparoscope_servo::test_support {

// Lengths of the pieces in which a stream is pushed, one after the other, again and again; each at least 1.
using Pieces = std::vector<std::size_t>;

struct CodecRun {
  std::vector<aesop::Bytes> frames;  // delivered, encoded again
  std::string violation;             // empty when all is well
};

// Pushes `stream` in pieces, and compares frames and counters with what PageDecoder makes of it.
inline CodecRun checkCodec(const aesop::Bytes& stream, const Pieces& pieces, const PageResult& page) {
  CodecRun run;
  std::ostringstream wrong;
  aesop::Decoder decoder;
  std::size_t piece = 0;
  for (std::size_t at = 0; at < stream.size();) {
    const std::size_t size = std::min(pieces[piece++ % pieces.size()], stream.size() - at);
    // A copy of its own, so that a read past its end is a read past the end of memory.
    const aesop::Bytes part(stream.begin() + static_cast<std::ptrdiff_t>(at),
                            stream.begin() + static_cast<std::ptrdiff_t>(at + size));
    for (const aesop::Frame& frame : decoder.push(part)) run.frames.push_back(aesop::encode(frame));
    if (decoder.pending() >= aesop::kFrameOverhead + aesop::kLargestPayload) wrong << "more than a frame is kept; ";
    at += size;
  }
  const auto compare = [&](const char* what, std::size_t ours, std::size_t of_page) {
    if (ours != of_page) wrong << what << ": " << ours << ", by the page " << of_page << "; ";
  };
  const aesop::DecoderStatistics& statistics = decoder.statistics();
  compare("frames", run.frames.size(), page.frames.size());
  compare("frames counted", statistics.frames, page.frames.size());
  compare("CRC errors", statistics.crc_errors, page.wrong.size());
  compare("bytes skipped", statistics.skipped_bytes, page.skipped);
  compare("malformed", statistics.malformed, page.malformed);
  compare("of another version", statistics.other_version, page.other_version);
  std::size_t delivered = 0;
  for (const aesop::Bytes& frame : run.frames) delivered += frame.size();
  compare("bytes", delivered + statistics.skipped_bytes + decoder.pending(), stream.size());
  for (std::size_t k = 0; k < std::min(run.frames.size(), page.frames.size()); ++k) {
    const auto start = stream.begin() + static_cast<std::ptrdiff_t>(page.frames[k].offset);
    if (!std::equal(run.frames[k].begin(), run.frames[k].end(), start)) {
      wrong << "frame " << k << " is not what was on the wire; ";
    }
  }
  run.violation = wrong.str();
  return run;
}

}  // namespace laparoscope_servo::test_support
