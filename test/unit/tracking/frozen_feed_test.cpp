#include "laparoscope_servo/tracking/frozen_feed.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::tracking {
namespace {

// One picture after the other at 25 Hz.
class FrozenFeedTest : public testing::Test {
 protected:
  bool frozen(int whole, int region, double step = 0.0, double robot = 0.0) {
    image::Repeats repeats;
    repeats.whole = whole;
    repeats.region = repeats.part = region;
    return frozen(repeats, {step, 0.0, robot});
  }
  bool frozen(const image::Repeats& repeats, const FrozenFeed::Motion& motion) {
    feed_.see(repeats, stamp_ += 0.04, motion);
    return !feed_.reason().empty();
  }
  static image::Repeats inPart(int count) {
    image::Repeats repeats;
    repeats.part = count;
    return repeats;
  }

  InputConfig config_;
  double stamp_ = 10.0;
  FrozenFeed feed_{config_};
};

TEST_F(FrozenFeedTest, SaysSoWithTheSecondWholePictureAndHowLong) {
  EXPECT_FALSE(frozen(0, 0));
  EXPECT_FALSE(frozen(1, 1));
  EXPECT_TRUE(frozen(2, 2));
  EXPECT_EQ(feed_.reason(), "the picture repeats: 2 images, 0.08 s");
}

TEST_F(FrozenFeedTest, IsOverAfterTwoNewPictures) {
  frozen(0, 0);
  frozen(1, 1);
  EXPECT_TRUE(frozen(2, 2));
  EXPECT_TRUE(frozen(0, 0));
  EXPECT_FALSE(frozen(0, 0));
}

TEST_F(FrozenFeedTest, StaysSaidWhereEveryNewPictureRepeats) {
  frozen(0, 0);
  for (int whole = 1; whole <= 4; ++whole) frozen(whole, whole);
  for (int k = 0; k < 20; ++k) {
    EXPECT_TRUE(frozen(0, 0)) << "5 Hz, repeated at 25 Hz";
    for (int whole = 1; whole <= 4; ++whole) EXPECT_TRUE(frozen(whole, whole));
  }
}

TEST_F(FrozenFeedTest, BearsAGrabberThatRepeatsEveryNth) {
  for (int k = 0; k < 100; ++k) EXPECT_FALSE(frozen(k % 2, k % 2, 3.0));
}

TEST_F(FrozenFeedTest, BearsARegionThatACodecSkipsWhileItIsStill) {
  frozen(0, 0);
  EXPECT_GE(config_.max_still_repeats, 2 * 19) << "19 in a row were seen, in one minute";
  for (int k = 1; k <= config_.max_still_repeats; ++k) EXPECT_FALSE(frozen(0, k));
  EXPECT_TRUE(frozen(0, config_.max_still_repeats + 1));
  EXPECT_NE(feed_.reason().find("within the region: " + std::to_string(config_.max_still_repeats + 1) + " images"),
            std::string::npos)
      << feed_.reason();
}

TEST_F(FrozenFeedTest, DoesNotBearItWhereTheRegionWasMoving) {
  for (int k = 0; k < 5; ++k) EXPECT_FALSE(frozen(0, 0, 1.0));
  EXPECT_FALSE(frozen(0, 1));
  EXPECT_TRUE(frozen(0, 2));
  EXPECT_TRUE(frozen(0, 3));
}

TEST_F(FrozenFeedTest, DoesNotBearItWhereTheRobotHasMovedIt) {
  frozen(0, 0);
  for (int k = 1; k <= 5; ++k) EXPECT_FALSE(frozen(0, k, 0.0, 0.3 * k));
  EXPECT_FALSE(frozen(0, 6, 0.0, 1.9));
  EXPECT_TRUE(frozen(0, 7, 0.0, 2.1));
}

TEST_F(FrozenFeedTest, BearsAPartThatACodecSkipsWhileTheRegionMovesByLittle) {
  for (int k = 0; k < 5; ++k) frozen(inPart(0), {1.0, 0.0, 0.0});
  for (int k = 1; k <= 100; ++k) EXPECT_FALSE(frozen(inPart(k), {0.1, 1.9, 0.01}));
}

TEST_F(FrozenFeedTest, DoesNotBearAPartThatStaysBehind) {
  frozen(inPart(0), {});
  EXPECT_FALSE(frozen(inPart(1), {3.0, 3.0, 0.0})) << "once, as in a grabber that repeats every nth";
  EXPECT_FALSE(frozen(inPart(2), {3.0, 6.0, 0.0})) << "twice, as a codec does under an instrument that swings";
  EXPECT_TRUE(frozen(inPart(3), {3.0, 9.0, 0.0}));
  EXPECT_EQ(feed_.reason(), "the picture repeats within a part of the region: 3 images, 0.12 s");
  EXPECT_TRUE(frozen(inPart(4), {})) << "nor where the region is lost by it";
  EXPECT_TRUE(frozen(inPart(0), {}));
  EXPECT_FALSE(frozen(inPart(0), {}));
}

TEST_F(FrozenFeedTest, DoesNotBearAPartThatTheRobotHasMoved) {
  for (int k = 0; k <= 2; ++k) EXPECT_FALSE(frozen(inPart(k), {0.0, 0.0, 0.9}));
  EXPECT_TRUE(frozen(inPart(3), {0.0, 0.0, 0.9})) << "image by image";
}

// A half of the picture that stands still repeats in the region, too: the rest of it may still tell of motion.
TEST_F(FrozenFeedTest, DoesNotBearARegionThatBeginsToMove) {
  frozen(0, 0, 0.2);
  EXPECT_FALSE(frozen(0, 1, 1.5));
  EXPECT_TRUE(frozen(0, 2, 3.0));
}

TEST_F(FrozenFeedTest, TakesOneEstimateThatJumpsForNoMotion) {
  for (int k = 0; k < 5; ++k) frozen(0, 0, 0.1);
  frozen(0, 0, 0.7);
  for (int k = 1; k <= 5; ++k) EXPECT_FALSE(frozen(0, k));
}

TEST_F(FrozenFeedTest, RefusesToBearAnythingWhereToldSo) {
  InputConfig strict;
  strict.max_repeats = 0;
  FrozenFeed feed(strict);
  image::Repeats once;
  once.whole = once.region = 1;
  feed.see(image::Repeats(), 1.0, {});
  feed.see(once, 1.04, {});
  EXPECT_FALSE(feed.reason().empty());
}

TEST(InputConfigTest, NamesWhatIsOutOfRange) {
  EXPECT_TRUE(validate(InputConfig()).empty());
  InputConfig config;
  config.max_repeats = -1;
  config.max_gap = 0.0;
  const auto errors = validate(config);
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_NE(errors[0].find("max_repeats = -1"), std::string::npos) << errors[0];
  EXPECT_NE(errors[1].find("max_gap = 0"), std::string::npos) << errors[1];
}

}  // namespace
}  // namespace laparoscope_servo::tracking
