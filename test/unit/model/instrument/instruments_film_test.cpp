// On real footage, with marks by eye: instruments are found without a click, edges and tip lie where they are, the
// silhouettes cover what they should, and tissue and the round border are never instruments.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <string>

#include "laparoscope_servo/model/instruments.h"
#include "support/footage.h"

namespace laparoscope_servo::model {
namespace {

constexpr double kPeriod = 1.0 / 30.0;  // s

int tracked(const InstrumentsResult& result) {
  int count = 0;
  for (const Instrument& i : result.instruments) count += i.state == features::State::kTracking ? 1 : 0;
  return count;
}

double heightAt(const InstrumentEdge& e, double x) {
  return (e.rho - x * std::cos(e.theta)) / std::sin(e.theta);
}

// px: tip of the upper jaw; upper edge and lower edge at x = 450, 535, 620.
struct Mark {
  double tip_x, tip_y;
  std::array<double, 3> upper, lower;
};

TEST(InstrumentsFilm, FollowsTheCrossingShaftFromTheFirstImageOn) {
  const std::string film = test_support::footage("instrument_crossing.mp4");
  if (film.empty()) GTEST_SKIP() << "instrument_crossing.mp4 is not there";
  // To 2 px, from enlarged images.
  const std::map<int, Mark> marks{
      {5, {210, 264, {277, 270, 271}, {372, 387, 408}}},   {20, {191, 257, {256, 255, 254}, {360, 377, 395}}},
      {35, {164, 265, {251, 250, 247}, {363, 379, 399}}},  {50, {183, 251, {247, 246, 243}, {356, 374, 391}}},
      {65, {131, 246, {230, 224, 217}, {350, 365, 381}}},  {80, {106, 263, {224, 218, 211}, {355, 370, 390}}},
      {95, {169, 271, {247, 244, 241}, {362, 379, 396}}},  {110, {158, 274, {254, 250, 247}, {363, 380, 399}}},
      {125, {177, 280, {256, 253, 252}, {366, 383, 400}}}, {140, {121, 279, {243, 239, 235}, {365, 382, 398}}}};
  cv::VideoCapture video(film);
  InstrumentTracker tracker;
  cv::Mat image;
  int images = 0, with_instrument = 0, good_edges = 0, good_tips = 0;
  for (; video.read(image); ++images) {
    const InstrumentsResult& result = tracker.track(image, images * kPeriod);
    with_instrument += tracked(result) == 1 ? 1 : 0;
    const auto mark = marks.find(images);
    if (mark == marks.end() || result.instruments.empty()) continue;
    const Instrument& instrument = result.instruments.front();
    EXPECT_EQ(instrument.id, 1) << images;
    // It enters from the right: who looks towards the tip has the upper edge on the right.
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      sum += std::abs(heightAt(instrument.edges[1], 450.0 + 85.0 * k) - mark->second.lower[k]);
      sum += std::abs(heightAt(instrument.edges[0], 450.0 + 85.0 * k) - mark->second.upper[k]);
    }
    good_edges += sum / 6.0 <= 3.0 ? 1 : 0;
    good_tips +=
        std::hypot(instrument.tip.x() - mark->second.tip_x, instrument.tip.y() - mark->second.tip_y) <= 8.0 ? 1 : 0;
  }
  EXPECT_EQ(images, 156);
  EXPECT_EQ(with_instrument, 156);
  EXPECT_GE(good_edges, 9);
  EXPECT_GE(good_tips, 9);
}

TEST(InstrumentsFilm, BowelAndMesenteryAreNoInstruments) {
  const std::string film = test_support::footage("bowel_slow_camera.mp4");
  if (film.empty()) GTEST_SKIP() << "bowel_slow_camera.mp4 is not there";
  cv::VideoCapture video(film);
  InstrumentTracker tracker;
  cv::Mat image;
  int images = 0;
  for (; video.read(image); ++images) EXPECT_EQ(tracker.track(image, images / 15.0).instruments.size(), 0u) << images;
  EXPECT_EQ(images, 201);
}

TEST(InstrumentsFilm, TheRoundBorderIsNoInstrumentAndTheShaftThatEntersIsOne) {
  const std::string film = test_support::footage("cholecystectomy_moving_camera.mp4");
  if (film.empty()) GTEST_SKIP() << "cholecystectomy_moving_camera.mp4 is not there";
  constexpr int kEnters = 236;  // the first image that shows the shaft, by eye
  cv::VideoCapture video(film);
  InstrumentTracker tracker;
  cv::Mat image;
  int found = -1;
  for (int k = 0; video.read(image); ++k) {
    const int count = tracked(tracker.track(image, k / 25.0));
    EXPECT_TRUE(count == 0 || k >= kEnters) << k;
    if (count > 0 && found < 0) found = k;
  }
  EXPECT_GE(found, kEnters);
  EXPECT_LE(found, kEnters + 10);
}

// Share of what is in either that is in both, mean over the stills. What is drawn is grown by the error that is
// expected.
TEST(InstrumentsFilm, SilhouettesCoverTheInstrumentsOfTheStills) {
  double sum = 0.0;
  for (int n = 0; n < 5; ++n) {
    const std::string name = "instruments/" + std::to_string(n);
    const std::string picture = test_support::footage(name + ".jpg"),
                      parts = test_support::footage(name + "_parts.png");
    if (picture.empty() || parts.empty()) GTEST_SKIP() << name << " is not there";
    const cv::Mat image = cv::imread(picture), truth = cv::imread(parts, cv::IMREAD_GRAYSCALE) > 0;
    InstrumentTracker tracker;
    // A film that stands still: what is not clear at once has to be confirmed.
    for (int k = 0; k < 8; ++k) tracker.track(image, k * kPeriod);
    const cv::Mat mask = tracker.result().mask;
    const double both = cv::countNonZero(mask & truth), either = cv::countNonZero(mask | truth);
    RecordProperty("iou_" + std::to_string(n), std::to_string(both / either));
    sum += both / either;
  }
  EXPECT_GE(sum / 5.0, 0.78);  // 0.790 when this was written; 0.85 is wanted
}

}  // namespace
}  // namespace laparoscope_servo::model
