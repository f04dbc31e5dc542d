#include "laparoscope_servo/image/repeat_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <opencv2/core.hpp>

namespace laparoscope_servo::image {
namespace {

const cv::Size kSize(200, 150);
const cv::Rect kRegion(70, 40, 90, 70);

class RepeatWatchTest : public testing::Test {
 protected:
  cv::Mat noise(int type = CV_8UC3) {
    cv::Mat image(kSize, type);
    random_.fill(image, cv::RNG::UNIFORM, 0, 256);
    return image;
  }

  cv::RNG random_{5};
  RepeatWatch watch_;
};

TEST_F(RepeatWatchTest, CountsPicturesThatRepeatUntilANewOneComes) {
  const cv::Mat first = noise();
  EXPECT_EQ(watch_.see(first, kRegion).whole, 0);
  for (int k = 1; k <= 5; ++k) {
    EXPECT_EQ(watch_.see(first, kRegion).whole, k);
  }
  const Repeats fresh = watch_.see(noise(), kRegion);
  EXPECT_EQ(fresh.whole, 0);
  EXPECT_EQ(fresh.region, 0);
}

TEST_F(RepeatWatchTest, SeesOneGreyLevelInAnyBlockOf4x4) {
  const cv::Mat first = noise();
  watch_.see(first, kRegion);
  for (int v = 0; v + 4 <= kSize.height; v += 4) {
    for (int u = 0; u + 4 <= kSize.width; u += 4) {
      cv::Mat other = first.clone();
      other(cv::Rect(u, v, 4, 4)) ^= cv::Scalar::all(1);
      RepeatWatch watch;
      watch.see(first, kRegion);
      ASSERT_LE(watch.see(other, kRegion).whole, 1);
      // A block of 4 rows holds a row of one field at least; that the other field alone repeats shows by its own count.
      cv::Mat both = first.clone();
      both(cv::Rect(u, v - v % 8, 4, std::min(8, kSize.height - (v - v % 8)))) ^= cv::Scalar::all(1);
      RepeatWatch strict;
      strict.see(first, kRegion);
      ASSERT_EQ(strict.see(both, kRegion).whole, 0) << u << ", " << v;
    }
  }
}

TEST_F(RepeatWatchTest, FindsOldPicturesThatComeInTurn) {
  for (int period = 2; period <= RepeatWatch::kMemory; ++period) {
    RepeatWatch watch;
    std::vector<cv::Mat> buffers;
    for (int k = 0; k < period; ++k) buffers.push_back(noise());
    for (const cv::Mat& buffer : buffers) EXPECT_EQ(watch.see(buffer, kRegion).whole, 0);
    int count = 0;
    for (int k = 0; k < 3 * period; ++k) {
      EXPECT_EQ(watch.see(buffers[static_cast<std::size_t>(k % period)], kRegion).whole, ++count);
    }
  }
}

// A loop of many old pictures: each shows motion and noise, but has been there before.
TEST_F(RepeatWatchTest, FindsALoopOfManyPictures) {
  std::vector<cv::Mat> pictures;
  for (int k = 0; k < 40; ++k) pictures.push_back(noise(CV_8UC1));
  for (const cv::Mat& picture : pictures) EXPECT_EQ(watch_.see(picture, kRegion).whole, 0);
  EXPECT_EQ(watch_.see(pictures[0], kRegion).whole, 0) << "one is none";
  for (int k = 1; k < 60; ++k) {
    EXPECT_EQ(watch_.see(pictures[static_cast<std::size_t>(k % 40)], kRegion).whole, k + 1);
  }
  EXPECT_EQ(watch_.see(noise(CV_8UC1), kRegion).whole, 0);
  watch_.clear();
  for (int k = 20; k < 40; ++k) {
    EXPECT_EQ(watch_.see(pictures[static_cast<std::size_t>(k)], kRegion).whole, 0) << "a film that began anew";
  }
}

// Forwards and back, as films for tests are made: what is seen again is no loop.
TEST_F(RepeatWatchTest, AFilmThatRunsBackwardsIsNoLoop) {
  std::vector<cv::Mat> pictures;
  for (int k = 0; k < 40; ++k) pictures.push_back(noise(CV_8UC1));
  for (const cv::Mat& picture : pictures) watch_.see(picture, kRegion);
  for (int k = 40 - RepeatWatch::kMemory; k-- > 0;) {
    EXPECT_EQ(watch_.see(pictures[static_cast<std::size_t>(k)], kRegion).whole, 0);
  }
}

TEST_F(RepeatWatchTest, FindsARegionThatRepeatsInALivePicture) {
  cv::Mat image = noise();
  watch_.see(image, kRegion);
  for (int k = 1; k <= 4; ++k) {
    cv::Mat live = noise();
    image(kRegion).copyTo(live(kRegion));
    const Repeats repeats = watch_.see(live, kRegion);
    EXPECT_EQ(repeats.region, k);
    EXPECT_EQ(repeats.whole, 0);
  }
  EXPECT_EQ(watch_.see(noise(), kRegion).region, 0);
}

// Of a picture that came in half, the other half is the last one's: part of the region moves on as if all did.
TEST_F(RepeatWatchTest, FindsAHalfThatStandsStillAndThatTheRegionReachesInto) {
  const cv::Size size(320, 256);
  const cv::Rect region(90, 60, 140, 140);
  const auto fresh = [&] {
    cv::Mat image(size, CV_8UC3);
    random_.fill(image, cv::RNG::UNIFORM, 0, 256);
    return image;
  };
  const cv::Mat first = fresh();
  const auto counted = [&](const cv::Rect& still, const cv::Rect& where) {
    RepeatWatch watch;
    for (int k = 0; k < RepeatWatch::kLive; ++k) watch.see(fresh(), where);
    watch.see(first, where);
    cv::Mat live = fresh();
    first(still).copyTo(live(still));
    const Repeats repeats = watch.see(live, where);
    EXPECT_EQ(repeats.whole, 0);
    return repeats.region;
  };
  EXPECT_EQ(counted(cv::Rect(0, 128, 320, 128), region), 1) << "lower";
  EXPECT_EQ(counted(cv::Rect(0, 0, 320, 128), region), 1) << "upper";
  EXPECT_EQ(counted(cv::Rect(0, 0, 160, 256), region), 1) << "left";
  EXPECT_EQ(counted(cv::Rect(160, 0, 160, 256), region), 1) << "right";
  EXPECT_EQ(counted(cv::Rect(0, 128, 320, 32), region), 0) << "a row of tiles alone, as a codec may skip it";
  EXPECT_EQ(counted(cv::Rect(0, 128, 288, 64), region), 0) << "not all across";
  EXPECT_EQ(counted(cv::Rect(0, 128, 320, 128), cv::Rect(90, 10, 140, 100)), 0) << "the region is not in it";
}

// A picture of 4:3 on a screen of 16:9, and a region that was drawn into the bar.
TEST_F(RepeatWatchTest, TakesNoBarBesideThePictureForAPartThatStandsStill) {
  const cv::Size size(512, 256);
  const cv::Rect bar(0, 0, 160, 256), region(64, 60, 160, 140);
  for (int k = 0; k < 30; ++k) {
    cv::Mat image(size, CV_8UC3);
    random_.fill(image, cv::RNG::UNIFORM, 0, 256);
    image(bar) = cv::Scalar(16, 16, 16);
    const Repeats repeats = watch_.see(image, region);
    ASSERT_EQ(repeats.region, 0) << k;
    ASSERT_EQ(repeats.part, 0) << k;
  }
}

// Of the region: how often a part repeats after `live` pictures that were new everywhere.
class PartTest : public RepeatWatchTest {
 protected:
  int parts(int live, const std::function<void(cv::Mat&, const cv::Mat&)>& keep, int still = 3) {
    RepeatWatch watch;
    for (int k = 0; k < live; ++k) watch.see(noise(), kRegion);
    const cv::Mat last = noise();
    watch.see(last, kRegion);
    Repeats repeats;
    for (int k = 0; k < still; ++k) {
      cv::Mat next = noise();
      keep(next, last);
      repeats = watch.see(next, kRegion);
      EXPECT_EQ(repeats.whole, 0);
    }
    return repeats.part;
  }
  static std::function<void(cv::Mat&, const cv::Mat&)> rectangle(const cv::Rect& where) {
    return [where](cv::Mat& next, const cv::Mat& last) { last(where).copyTo(next(where)); };
  }
};

TEST_F(PartTest, CountsAPartOfAnyShapeThatHoldsAQuarterOfTheTexture) {
  EXPECT_EQ(parts(6, rectangle(kRegion)), 3) << "all of it";
  EXPECT_EQ(parts(6, rectangle(cv::Rect(0, 0, 112, 150))), 3) << "left";
  EXPECT_EQ(parts(6, rectangle(cv::Rect(0, 80, 200, 70))), 3) << "below";
  EXPECT_EQ(parts(6, rectangle(cv::Rect(112, 64, 88, 86))), 3) << "a corner";
  EXPECT_EQ(parts(6, rectangle(cv::Rect(64, 64, 96, 32))), 3) << "a stripe";
  EXPECT_EQ(parts(6,
                  [](cv::Mat& next, const cv::Mat& last) {
                    for (int row = kRegion.y; row < kRegion.br().y; row += 4) {
                      const cv::Rect line(kRegion.x, row, kRegion.width, 1);
                      last(line).copyTo(next(line));
                    }
                  }),
            3)
      << "one line in four";
  EXPECT_EQ(parts(6,
                  [](cv::Mat& next, const cv::Mat& last) {
                    for (int row = 0; row < next.rows; row += 32) {
                      const int end = std::min(row + 16, next.rows);
                      last.rowRange(row, end).copyTo(next.rowRange(row, end));
                    }
                  }),
            3)
      << "every second row of blocks";
}

TEST_F(PartTest, CountsNothingThatIsSmallOrBesideTheRegion) {
  EXPECT_EQ(parts(6, rectangle(cv::Rect(80, 48, 16, 16))), 0) << "one block";
  EXPECT_EQ(parts(6, rectangle(cv::Rect(0, 0, 80, 150))), 0) << "left of it";
  EXPECT_EQ(parts(6, rectangle(cv::Rect(0, 0, 200, 48))), 0) << "above";
}

TEST_F(PartTest, CountsNoFlatPartNorWhatIsBurntIn) {
  const auto flat = [](cv::Mat& next, const cv::Mat&) { next(cv::Rect(0, 64, 200, 86)).setTo(255); };
  EXPECT_EQ(parts(6, flat), 0) << "saturated";
  RepeatWatch watch;
  const cv::Mat logo = noise()(cv::Rect(80, 48, 48, 48)).clone();
  for (int k = 0; k < 30; ++k) {
    cv::Mat next = noise();
    logo.copyTo(next(cv::Rect(80, 48, 48, 48)));
    EXPECT_EQ(watch.see(next, kRegion).part, 0) << k;
  }
}

TEST_F(RepeatWatchTest, FindsAFieldThatStandsStill) {
  const cv::Mat first = noise();
  for (const int still : {0, 1}) {
    RepeatWatch watch;
    watch.see(first, kRegion);
    cv::Mat woven = noise();
    for (int row = still; row < kSize.height; row += 2) first.row(row).copyTo(woven.row(row));
    EXPECT_EQ(watch.see(woven, kRegion).whole, 1) << still;
  }
}

TEST_F(RepeatWatchTest, TakesAnyPlaceOfTheRegionAndAnySizeAndType) {
  const cv::Mat grey = noise(CV_8UC1);
  for (const cv::Rect& region : {cv::Rect(), cv::Rect(-50, -50, 60, 60), cv::Rect(190, 140, 100, 100),
                                 cv::Rect(1000, 1000, 5, 5), cv::Rect(33, 33, 3, 3)}) {
    RepeatWatch watch;
    watch.see(grey, region);
    EXPECT_EQ(watch.see(grey, region).region, 1);
  }
  const cv::Mat pixel(1, 1, CV_8UC3, cv::Scalar(1, 2, 3));
  RepeatWatch watch;
  watch.see(pixel, kRegion);
  EXPECT_EQ(watch.see(pixel, kRegion).whole, 1);
  EXPECT_EQ(watch.see(grey, kRegion).whole, 0) << "another size";
  cv::Mat part = noise()(kRegion);  // rows with gaps between them
  EXPECT_EQ(watch.see(part, kRegion).whole, 0);
  EXPECT_EQ(watch.see(part.clone(), kRegion).whole, 1);
}

}  // namespace
}  // namespace laparoscope_servo::image
