// Damaged streams of good frames: nothing may come out that nobody sent, but for what 16 bits of check sum let through.
// LAPAROSCOPE_SERVO_STREAMS says how many; scripts/fuzz runs the same under sanitizers.
#include <gtest/gtest.h>

#include <cstdlib>

#include "support/false_frames.h"

namespace laparoscope_servo::test_support {
namespace {

std::uint64_t streams() {
  const char* wanted = std::getenv("LAPAROSCOPE_SERVO_STREAMS");
  return wanted == nullptr ? 100000 : std::strtoull(wanted, nullptr, 10);
}

TEST(DamagedStreams, noFalseFrameBeyondChance) {
  ASSERT_GT(streams(), 0u) << "LAPAROSCOPE_SERVO_STREAMS, expected a whole number above 0";
  FalseFramesByKind counts;
  ASSERT_EQ(countFalseFrames(streams(), 1, counts), "");
  FalseFrames all;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    SCOPED_TRACE(StreamMutator::kKinds[k]);
    EXPECT_GT(counts[k].comparisons, counts[k].streams / 10) << "the damage does no harm";
    EXPECT_EQ(beyondChance(counts[k]), "");
    all += counts[k];
  }
  EXPECT_EQ(beyondChance(all), "");
  EXPECT_LT(all.delivered, all.sent);
  EXPECT_GT(all.delivered, all.streams);
}

// The judge itself: it has to notice a decoder whose sums mean nothing.
TEST(DamagedStreams, theJudgeNoticesFalseFrames) {
  EXPECT_NEAR(chanceOfAtLeast(1, 1.0), 1.0 - std::exp(-1.0), 1e-12);
  EXPECT_NEAR(chanceOfAtLeast(2, 1.0), 1.0 - 2.0 * std::exp(-1.0), 1e-12);
  EXPECT_NEAR(chanceOfAtLeast(400, 400.0), 0.5, 0.02);
  FalseFrames count;
  count.comparisons = count.plausible = 65536 * 100;
  count.right = count.false_frames = 130;
  EXPECT_EQ(beyondChance(count), "");
  count.right = count.false_frames = 160;
  EXPECT_NE(beyondChance(count).find("sums are right"), std::string::npos);
  count.comparisons *= 2;
  EXPECT_NE(beyondChance(count).find("false frames"), std::string::npos);
}

TEST(DamagedStreams, aFrameThatWasNotSentCounts) {
  MutatedStream stream;
  stream.sent = {aesop::encode({1, aesop::Poll()})};
  stream.bytes = stream.sent[0];
  EXPECT_EQ(countFalseFrames(stream, PageDecoder::decode(stream.bytes)).false_frames, 0u);
  stream.bytes = aesop::encode({2, aesop::Poll()});
  EXPECT_EQ(countFalseFrames(stream, PageDecoder::decode(stream.bytes)).false_frames, 1u);
}

}  // namespace
}  // namespace laparoscope_servo::test_support
