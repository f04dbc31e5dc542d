#include "ros/playback/video_length.h"

#include <gtest/gtest.h>

#include <string>

namespace laparoscope_servo {
namespace {

// The head of a film of 25 Hz in milliseconds, in Matroska, whose tag tells its duration.
class VideoLengthTest : public testing::Test {
 protected:
  VideoLengthTest() : format_(avformat_alloc_context()), stream_(avformat_new_stream(format_, nullptr)) {
    format_->iformat = const_cast<decltype(format_->iformat)>(av_find_input_format("matroska"));
    stream_->time_base = {1, 1000};
    stream_->avg_frame_rate = {25, 1};
  }
  ~VideoLengthTest() override { avformat_free_context(format_); }

  VideoLength told(const std::string& duration) {
    av_dict_set(&stream_->metadata, "DURATION", duration.c_str(), 0);
    return {*format_, *stream_};
  }
  static void read(VideoLength& length, int pictures) {
    for (int k = 0; k < pictures; ++k) {
      length.read(0.04 * k, 0.04, true);
      if (k > 0) length.came(0.04);
    }
  }

  AVFormatContext* format_;
  AVStream* stream_;
};

TEST_F(VideoLengthTest, aFilmThatKeepsWhatItsTagPromisesIsWhole) {
  VideoLength length = told("00:00:02.000000000");
  EXPECT_EQ(length.rate(), 25.0);
  read(length, 50);
  EXPECT_DOUBLE_EQ(length.end(), 2.0);
  EXPECT_FALSE(length.missing(50));
}

TEST_F(VideoLengthTest, whatIsMissingIsCountedByTheTime) {
  VideoLength length = told("00:00:02.000000000");
  read(length, 30);
  const auto missing = length.missing(30);
  ASSERT_TRUE(missing);
  EXPECT_EQ(missing->count, 20u);
  EXPECT_EQ(missing->error, "the video breaks off at 1.200 s, expected at 2.000 s");
}

// The last period is not always known.
TEST_F(VideoLengthTest, oneLongPeriodMayBeMissing) {
  VideoLength length = told("00:00:02.000000000");
  read(length, 30);
  length.came(0.6);
  EXPECT_FALSE(length.missing(30));
}

TEST_F(VideoLengthTest, aTagThatIsNoTimePromisesNothing) {
  for (const char* const tag : {"00:00:inf", "00:00:nan", "00:00:-inf", "2 s", ""}) {
    VideoLength length = told(tag);
    read(length, 30);
    EXPECT_FALSE(length.missing(30)) << tag;
  }
}

}  // namespace
}  // namespace laparoscope_servo
