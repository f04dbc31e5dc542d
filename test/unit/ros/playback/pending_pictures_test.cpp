#include "ros/playback/pending_pictures.h"

#include <gtest/gtest.h>

namespace laparoscope_servo {
namespace {

std::vector<int> times(const std::vector<PendingPictures::Sent>& pictures) {
  std::vector<int> result;
  for (const auto& picture : pictures) result.push_back(picture.time ? static_cast<int>(*picture.time) : -1);
  return result;
}

using Times = std::vector<int>;

TEST(PendingPictures, NothingIsMissingWhenAllCameInTheOrderOfTime) {
  PendingPictures pending;  // I P B B P B B, as a decoder gets and gives them
  const std::vector<int> sent{0, 3, 1, 2, 6, 4, 5};
  for (std::size_t k = 0; k < sent.size(); ++k) pending.sent(static_cast<std::int64_t>(k), {sent[k]});
  for (const int index : {0, 2, 3, 1, 5, 6, 4}) EXPECT_EQ(times(pending.came(index, sent[index])), Times{});
  EXPECT_EQ(times(pending.end()), Times{});
}

TEST(PendingPictures, NamesWhatIsMissingInItsOrder) {
  PendingPictures pending;
  for (int k = 0; k < 8; ++k) pending.sent(k, {k < 4 ? 30 - 10 * k : 10 * k});  // 30 20 10 0 40 50 60 70
  EXPECT_EQ(times(pending.came(0, 30)), Times{}) << "those that went in later may still come";
  EXPECT_EQ(times(pending.came(5, 50)), (Times{0, 10, 20, 40}));
  EXPECT_EQ(times(pending.end()), (Times{60, 70}));
}

TEST(PendingPictures, SmallerTimesOfASecondRecordingAreNotMissing) {
  PendingPictures pending;
  pending.sent(0, {100});
  pending.sent(1, {140});
  pending.sent(2, {0});
  pending.sent(3, {40});
  for (const auto& [index, time] : {std::pair{0, 100}, {1, 140}, {2, 0}, {3, 40}}) {
    EXPECT_EQ(times(pending.came(index, time)), Times{});
  }
}

TEST(PendingPictures, WithoutTimesOnlyWhatIsLongOverdueIsMissing) {
  PendingPictures pending;
  for (int k = 0; k < 100; ++k) pending.sent(k, {});
  EXPECT_EQ(times(pending.came(1, 1)), Times{});
  EXPECT_EQ(times(pending.came(64, 2)), Times{});
  EXPECT_EQ(times(pending.came(65, 3)), Times{-1});
}

}  // namespace
}  // namespace laparoscope_servo
