// libFuzzer's target: any bytes, in pieces of any length, through the decoder. The first byte chooses the pieces.
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "support/codec_check.h"

namespace {

using namespace laparoscope_servo;
using test_support::PageDecoder;

// Makes right the sum of whatever looks like a frame, or all damage would end at the sum.
void repairSums(std::uint8_t* data, std::size_t size) {
  for (std::size_t at = 1; at + aesop::kFrameOverhead <= size; ++at) {
    if (data[at] != 0xA5 || data[at + 1] != 0x5A) continue;
    const std::size_t payload = data[at + 3];
    if (payload > aesop::kLargestPayload || at + aesop::kFrameOverhead + payload > size) continue;
    const unsigned sum = PageDecoder::crc(data + at + 2, payload + 5);
    data[at + 7 + payload] = static_cast<std::uint8_t>(sum & 0xFF);
    data[at + 8 + payload] = static_cast<std::uint8_t>(sum >> 8);
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  size = LLVMFuzzerMutate(data, size, max_size);
  if (seed % 4 != 0) repairSums(data, size);
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const aesop::Bytes stream(data + 1, data + size);
  const test_support::Pieces pieces = {1u + data[0] % 16u, 1u + data[0] / 16u * 6u};
  const std::string violation = test_support::checkCodec(stream, pieces, PageDecoder::decode(stream)).violation;
  if (violation.empty()) return 0;
  std::fprintf(stderr, "%s\n", violation.c_str());
  std::abort();
}
