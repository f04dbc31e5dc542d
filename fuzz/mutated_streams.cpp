// mutated_streams [STREAMS [SEED]]: so many streams of good frames, damaged, through the decoder; prints how many
// frames came out that nobody had sent, beside what 16 bits of check sum let through. Exit status 1 when there were
// more, or when the decoder did not keep its word.
#include <cstdio>
#include <cstdlib>

#include "support/false_frames.h"

namespace {

using namespace laparoscope_servo::test_support;

void print(const char* kind, const FalseFrames& count) {
  const double right = static_cast<double>(count.comparisons) * kSumsByChance;
  const double delivered = static_cast<double>(count.plausible) * kSumsByChance;
  std::printf("%-15s %10llu %12llu %7llu %9.1f +- %-6.1f %11llu %7llu %8.2f +- %.2f\n", kind,
              static_cast<unsigned long long>(count.streams), static_cast<unsigned long long>(count.comparisons),
              static_cast<unsigned long long>(count.right), right, std::sqrt(right),
              static_cast<unsigned long long>(count.plausible), static_cast<unsigned long long>(count.false_frames),
              delivered, std::sqrt(delivered));
}

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t streams = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 100000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  if (streams == 0) {
    std::fprintf(stderr, "mutated_streams: STREAMS = '%s', expected a whole number above 0\n", argv[1]);
    return 2;
  }
  FalseFramesByKind counts;
  const std::string violation = countFalseFrames(streams, seed, counts);
  if (!violation.empty()) {
    std::fprintf(stderr, "mutated_streams: seed %llu, %s\n", static_cast<unsigned long long>(seed), violation.c_str());
    return 1;
  }
  std::printf("%-15s %10s %12s %7s %19s %11s %7s %16s\n", "damage", "streams", "comparisons", "right", "expected",
              "plausible", "false", "expected");
  FalseFrames all;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    print(StreamMutator::kKinds[k], counts[k]);
    all += counts[k];
  }
  print("all", all);
  std::printf("%llu bytes, %llu frames sent, %llu delivered\n", static_cast<unsigned long long>(all.bytes),
              static_cast<unsigned long long>(all.sent), static_cast<unsigned long long>(all.delivered));
  const std::string verdict = beyondChance(all);
  if (verdict.empty()) return 0;
  std::fprintf(stderr, "mutated_streams: %s\n", verdict.c_str());
  return 1;
}
