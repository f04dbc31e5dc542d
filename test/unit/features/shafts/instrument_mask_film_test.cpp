// On real footage: tissue, highlights and the round border are never taken for an instrument, and shafts are found.
#include <gtest/gtest.h>

#include <opencv2/videoio.hpp>
#include <string>

#include "laparoscope_servo/features/instrument_mask.h"
#include "support/footage.h"

namespace laparoscope_servo::features {
namespace {

struct Counts {
  int images = 0, with_instrument = 0;
  int first = -1;  // image with one
};

Counts count(const std::string& film) {
  cv::VideoCapture video(film);
  Counts counts;
  for (cv::Mat image; video.read(image); ++counts.images) {
    if (instrumentMask(image).empty()) continue;
    ++counts.with_instrument;
    if (counts.first < 0) counts.first = counts.images;
  }
  return counts;
}

TEST(InstrumentMaskFilm, BowelAndMesenteryAreNoInstruments) {
  const std::string film = test_support::footage("bowel_slow_camera.mp4");
  if (film.empty()) GTEST_SKIP() << "bowel_slow_camera.mp4 is not there";
  const Counts counts = count(film);
  EXPECT_EQ(counts.images, 201);
  EXPECT_EQ(counts.with_instrument, 0) << counts.first;
}

TEST(InstrumentMaskFilm, TheRoundBorderIsNoInstrumentAndTheShaftThatEntersIsOne) {
  const std::string film = test_support::footage("cholecystectomy_moving_camera.mp4");
  if (film.empty()) GTEST_SKIP() << "cholecystectomy_moving_camera.mp4 is not there";
  const Counts counts = count(film);
  EXPECT_EQ(counts.images, 250);
  EXPECT_GE(counts.first, 236);  // the first image that shows it, by eye
  EXPECT_LE(counts.first, 238);
  EXPECT_GE(counts.with_instrument, 8);  // of 13; 10 when this was written
}

TEST(InstrumentMaskFilm, TheCrossingShaftIsFoundInEachImage) {
  const std::string film = test_support::footage("instrument_crossing.mp4");
  if (film.empty()) GTEST_SKIP() << "instrument_crossing.mp4 is not there";
  const Counts counts = count(film);
  EXPECT_EQ(counts.images, 156);
  EXPECT_GE(counts.with_instrument, 154);
}

}  // namespace
}  // namespace laparoscope_servo::features
