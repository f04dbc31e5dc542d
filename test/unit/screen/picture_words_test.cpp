#include "screen/picture_words.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::screen {
namespace {

Picture picture(double arrived_at, double changed_at, double age = 0.0) {
  Picture picture;
  picture.image = QImage(4, 4, QImage::Format_RGB32);
  picture.arrived_at = arrived_at;
  picture.changed_at = changed_at;
  picture.age_at_arrival = age;
  return picture;
}

TEST(PictureWords, AFreshPictureIsLive) {
  EXPECT_TRUE(pictureWords(picture(100.0, 100.0, 0.05), 100.1).live);
  EXPECT_TRUE(pictureWords(picture(100.0, 100.0, 0.05), 100.1).words.empty());
}

TEST(PictureWords, AnOldOneSaysItsAge) {
  const PictureWords words = pictureWords(picture(100.0, 100.0), 103.24);
  EXPECT_FALSE(words.live);
  EXPECT_EQ(words.words, "NOT LIVE");
  EXPECT_EQ(words.detail, "This picture is 3.2 s old.");
  EXPECT_EQ(pictureWords(picture(100.0, 100.0), 160.0).detail, "This picture is 60 s old.");
  EXPECT_FALSE(pictureWords(picture(100.0, 100.0), 100.26).live);
}

TEST(PictureWords, OneThatCameLateIsOldAtOnce) {
  EXPECT_FALSE(pictureWords(picture(100.0, 100.0, 0.4), 100.0).live);
  EXPECT_TRUE(pictureWords(picture(100.0, 100.0, -5.0), 100.0).live) << "clocks that differ make nothing fresh or old";
}

TEST(PictureWords, OneThatRepeatsStandsStill) {
  const PictureWords words = pictureWords(picture(101.5, 100.0), 101.51);
  EXPECT_FALSE(words.live);
  EXPECT_EQ(words.words, "STANDS STILL");
  EXPECT_TRUE(pictureWords(picture(100.2, 100.0), 100.2).live) << "a few repeated ones are a codec's";
}

TEST(PictureWords, NoPictureIsSaid) {
  EXPECT_EQ(pictureWords(Picture(), 100.0).words, "NO PICTURE");
}

TEST(PictureWords, AClockThatIsNoneMakesNothingLive) {
  EXPECT_FALSE(pictureWords(picture(100.0, 100.0), std::numeric_limits<double>::quiet_NaN()).live);
}

PlaybackFacts recording(const std::string& state, double period = 0.04) {
  PlaybackFacts playback;
  playback.connected = true;
  playback.state = state;
  playback.period = period;
  return playback;
}

TEST(PictureWords, ARecordingSaysThatItHasEnded) {
  const Picture last = picture(10.0, 10.0);
  EXPECT_EQ(pictureWords(last, 10.0, recording("ENDED")).words, "ENDED");
  EXPECT_NE(pictureWords(last, 10.0, recording("ENDED")).detail.find("\"Again\""), std::string::npos)
      << "and what to press";
  EXPECT_FALSE(pictureWords(last, 10.0, recording("ENDED")).live);
  EXPECT_TRUE(pictureWords(last, 99.0, recording("PAUSED")).live) << "it stands because somebody wants it to";
  EXPECT_TRUE(pictureWords(last, 99.0, recording("HOLDING")).live);
  EXPECT_EQ(pictureWords(last, 99.0, recording("PLAYING")).words, "NOT LIVE");
  EXPECT_FALSE(pictureWords(Picture(), 99.0, recording("PAUSED")).live);
}

TEST(PictureWords, ARecordingThatCannotBeReadSaysWhy) {
  PlaybackFacts failed = recording("FAILED");
  failed.reason = "'film.bag' is empty, expected a bag";
  for (const Picture& shown : {Picture(), picture(10.0, 10.0)}) {
    EXPECT_FALSE(pictureWords(shown, 10.0, failed).live);
    EXPECT_EQ(pictureWords(shown, 10.0, failed).words, "UNREADABLE");
    EXPECT_EQ(pictureWords(shown, 10.0, failed).detail, "There is nothing in the file.");
  }
  failed.connected = false;
  EXPECT_EQ(pictureWords(Picture(), 10.0, failed).words, "NO PICTURE") << "the player has ended";
}

TEST(PictureWords, ARecordingThatPlaysSlowlyIsLive) {
  const Picture last = picture(10.0, 10.0);
  EXPECT_TRUE(pictureWords(last, 10.4, recording("PLAYING", 0.2)).live) << "a fifth of 25 Hz";
  EXPECT_EQ(pictureWords(last, 10.6, recording("PLAYING", 0.2)).words, "NOT LIVE");
  EXPECT_TRUE(pictureWords(picture(10.4, 10.0), 10.4, recording("PLAYING", 0.2)).live) << "a picture comes twice";
  EXPECT_FALSE(pictureWords(last, 10.3, recording("PLAYING", 0.01)).live) << "a fast one is live no shorter, no longer";
  EXPECT_TRUE(pictureWords(last, 10.2, recording("PLAYING", 0.01)).live);
  EXPECT_FALSE(pictureWords(last, 10.3, recording("PLAYING", std::numeric_limits<double>::infinity())).live);
  PlaybackFacts gone = recording("PLAYING", 0.2);
  gone.connected = false;
  EXPECT_FALSE(pictureWords(last, 10.4, gone).live) << "a camera's pictures may not be that old";
}

}  // namespace
}  // namespace laparoscope_servo::screen
