#include "laparoscope_servo/image/cut_finder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "support/synthetic_sequence.h"

namespace laparoscope_servo::image {
namespace {

using Film = std::vector<cv::Mat>;

const cv::Size kSize(320, 256);
const cv::Point kMiddle(640, 100);  // of a scene, where most shots begin

const cv::Mat& scene(int number) {
  static const std::vector<cv::Mat> scenes = [] {
    std::vector<cv::Mat> made;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) made.push_back(test_support::texture(cv::Size(1600, 456), seed));
    return made;
  }();
  return scenes.at(static_cast<std::size_t>(number));
}

cv::Mat seenAt(int number, const cv::Point& corner) {
  return scene(number)(cv::Rect(corner, kSize)).clone();
}

// A camera that moves by `step` px an image.
Film shot(int number, int images, const cv::Point& step = {2, 1}) {
  Film film;
  for (int k = 0; k < images; ++k) film.push_back(seenAt(number, kMiddle + k * step));
  return film;
}

Film operator+(Film film, const Film& other) {
  film.insert(film.end(), other.begin(), other.end());
  return film;
}

std::string cutsOf(const Film& film, double rate = 25.0) {
  CutFinder finder(rate);
  std::string text;
  const auto tell = [&text](const Cut& cut) {
    text += (text.empty() ? "" : ", ") + std::to_string(cut.last) + "-" + std::to_string(cut.first);
  };
  for (const cv::Mat& image : film) {
    const std::size_t decided = finder.undecided();
    if (const auto cut = finder.see(image)) {
      EXPECT_GE(cut->first, decided);
      tell(*cut);
    }
  }
  for (const Cut& cut : finder.end()) tell(cut);
  return text;
}

TEST(CutFinder, TellsTheImageWithWhichAnotherSceneBegins) {
  EXPECT_EQ(cutsOf(shot(0, 20) + shot(1, 20)), "19-20");
  EXPECT_EQ(cutsOf(shot(0, 20) + shot(1, 20) + shot(2, 12) + shot(0, 3)), "19-20, 39-40, 51-52");
  EXPECT_EQ(cutsOf(shot(0, 8) + shot(1, 8), 6.0), "7-8");
  EXPECT_EQ(cutsOf(shot(0, 50)), "");
  EXPECT_EQ(cutsOf({}), "");
}

TEST(CutFinder, TakesGreyAndLargeImages) {
  Film grey = shot(0, 20) + shot(1, 20), large = grey;
  for (cv::Mat& image : grey) cv::cvtColor(image, image, cv::COLOR_BGR2GRAY);
  for (cv::Mat& image : large) cv::resize(image, image, cv::Size(), 4.0, 4.0, cv::INTER_LINEAR);
  EXPECT_EQ(cutsOf(grey), "19-20");
  EXPECT_EQ(cutsOf(large), "19-20");
}

TEST(CutFinder, TellsACutBetweenShotsThatMove) {
  EXPECT_EQ(cutsOf(shot(0, 20, {10, 0}) + shot(1, 20, {-10, 0})), "19-20");
}

// A jerk that takes the view by up to twice its width in half a second, blurred by the exposure.
TEST(CutFinder, AFastMoveIsNone) {
  const cv::Point begin(1200, kMiddle.y);
  for (const int most : {16, 32, 48, 64}) {
    Film film(10, seenAt(0, begin));
    double x = begin.x;
    for (int k = 0; k < 14; ++k) {
      const double speed = most * std::min({(k + 1) / 3.0, (14 - k) / 3.0, 1.0});
      cv::Mat blurred = cv::Mat::zeros(kSize, CV_32FC3);
      for (int part = 0; part < 8; ++part)
        cv::accumulate(seenAt(0, {cvRound(x - speed * part / 8.0), begin.y}), blurred);
      blurred.convertTo(blurred, CV_8U, 1.0 / 8.0);
      film.push_back(blurred);
      x -= speed;
    }
    for (int k = 0; k < 20; ++k) film.push_back(seenAt(0, {cvRound(x), begin.y}));
    EXPECT_EQ(cutsOf(film), "") << most << " px an image";
  }
}

TEST(CutFinder, ATurnAndAZoomAreNone) {
  Film film;
  for (int k = 0; k < 40; ++k) {
    const cv::Mat turn = cv::getRotationMatrix2D(cv::Point2f(800.0f, 228.0f), 4.0 * k, 1.0 + 0.03 * k);
    cv::Mat view;
    cv::warpAffine(scene(0), view, turn, scene(0).size(), cv::INTER_LINEAR, cv::BORDER_REFLECT_101);
    film.push_back(view(cv::Rect(kMiddle, kSize)).clone());
  }
  EXPECT_EQ(cutsOf(film), "");
}

TEST(CutFinder, AFlashIsNone) {
  for (const int images : {1, 2, 5, 8}) {
    Film film = shot(0, 40);
    for (int k = 20; k < 20 + images; ++k)
      film[static_cast<std::size_t>(k)] = 3.0 * film[static_cast<std::size_t>(k)] + cv::Scalar::all(60.0);
    EXPECT_EQ(cutsOf(film), "") << images << " images";
  }
}

TEST(CutFinder, AnInstrumentThatCrossesIsNone) {
  for (const int speed : {20, 60, 120}) {
    Film film = shot(0, 60);
    for (int k = 20; k < 60; ++k) {
      const int x = -160 + speed * (k - 20);
      cv::rectangle(film[static_cast<std::size_t>(k)], cv::Point(x, 0), cv::Point(x + 160, kSize.height),
                    cv::Scalar(70, 70, 75), cv::FILLED);
      cv::line(film[static_cast<std::size_t>(k)], cv::Point(x + 40, 0), cv::Point(x + 60, kSize.height),
               cv::Scalar::all(240), 6);
    }
    EXPECT_EQ(cutsOf(film), "") << speed << " px an image";
  }
}

TEST(CutFinder, SmokeThatHidesAllIsNone) {
  Film film = shot(0, 90, {1, 0});
  for (int k = 20; k < 70; ++k) {
    const double veil = 0.98 * std::min({(k - 19) / 6.0, (70 - k) / 20.0, 1.0});
    cv::Mat& image = film[static_cast<std::size_t>(k)];
    cv::addWeighted(image, 1.0 - veil, cv::Mat(kSize, CV_8UC3, cv::Scalar(200, 205, 210)), veil, 0.0, image);
  }
  EXPECT_EQ(cutsOf(film), "");
}

TEST(CutFinder, AGlitchIsNoneAndAnInsertIsTwo) {
  EXPECT_EQ(cutsOf(shot(0, 20) + shot(1, 4) + shot(0, 20)), "");
  EXPECT_EQ(cutsOf(shot(0, 20) + shot(1, 30) + shot(0, 20)), "19-20, 49-50");
}

TEST(CutFinder, DarkImagesBelongToNoScene) {
  const Film dark(30, cv::Mat(kSize, CV_8UC3, cv::Scalar::all(3)));
  EXPECT_EQ(cutsOf(shot(0, 20) + dark + shot(1, 20)), "19-50");
  EXPECT_EQ(cutsOf(shot(0, 20) + dark + shot(0, 20)), "");
  EXPECT_EQ(cutsOf(dark + shot(0, 20) + dark), "");
}

TEST(CutFinder, AMixtureBelongsToNoScene) {
  Film film = shot(0, 21, {0, 0}) + shot(1, 20);
  film[20] = 0.5 * seenAt(0, kMiddle) + 0.5 * seenAt(1, kMiddle);
  EXPECT_EQ(cutsOf(film), "19-21");
}

// A scope that is withdrawn into its tube: the opening shrinks by a fifth with each image, the tube stands.
TEST(CutFinder, AWithdrawalThroughATubeIsNone) {
  Film film = shot(0, 12, {0, 0});
  double radius = 300.0;
  for (int k = 0; k < 30; ++k) {
    radius = std::max(0.8 * radius, 12.0);
    const double scale = std::max(radius / 300.0, 0.1);
    cv::Mat small, view = 0.3 * seenAt(2, kMiddle) + cv::Scalar::all(120.0), mask(kSize, CV_8U, cv::Scalar(0));
    const cv::Matx23d shrink(scale, 0.0, 160.0 * (1.0 - scale), 0.0, scale, 128.0 * (1.0 - scale));
    cv::warpAffine(seenAt(0, kMiddle), small, shrink, kSize, cv::INTER_AREA, cv::BORDER_REFLECT_101);
    cv::circle(mask, {160, 128}, cvRound(radius), 255, cv::FILLED);
    small.copyTo(view, mask);
    film.push_back(view);
  }
  EXPECT_EQ(cutsOf(film), "");
}

TEST(CutFinder, ImagesThatCannotBeUsedCount) {
  CutFinder finder(25.0);
  std::optional<Cut> cut;
  const auto take = [&cut](const std::optional<Cut>& told) {
    if (told) cut = told;
  };
  for (const cv::Mat& image : shot(0, 20)) take(finder.see(image));
  for (int k = 0; k < 4; ++k) take(finder.miss());
  for (const cv::Mat& image : shot(1, 20)) take(finder.see(image));
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->last, 19u);
  EXPECT_EQ(cut->first, 24u);
}

TEST(CutFinder, ACutToThePlaceThatWasSeenIsNone) {
  Film moved;
  for (int k = 0; k < 20; ++k) moved.push_back(seenAt(0, kMiddle + cv::Point(60 + k, 10)));
  EXPECT_EQ(cutsOf(shot(0, 20, {1, 0}) + moved), "");
}

// What is the same in all scenes does not hide a cut: the border of a round picture, and text laid over it.
TEST(CutFinder, BordersAndTextThatStayHideNoCut) {
  Film film = shot(0, 20) + shot(1, 20);
  for (cv::Mat& image : film) {
    cv::Mat beyond(kSize, CV_8U, cv::Scalar(255));
    cv::circle(beyond, {160, 128}, 140, 0, cv::FILLED);
    image.setTo(cv::Scalar::all(0), beyond);
    cv::putText(image, "12:30", {130, 60}, cv::FONT_HERSHEY_SIMPLEX, 0.7, cv::Scalar::all(255), 2);
  }
  EXPECT_EQ(cutsOf(film), "19-20");
}

TEST(CutFinder, WithoutStructureThereIsNone) {
  const Film bare(20, cv::Mat(kSize, CV_8UC3, cv::Scalar(90, 100, 150)));
  EXPECT_EQ(cutsOf(bare + shot(0, 20)), "");
  EXPECT_EQ(cutsOf(shot(0, 20) + bare), "");
}

TEST(CutFinder, RefusesARateThatIsNone) {
  for (const double rate : {0.0, -25.0, std::nan(""), HUGE_VAL}) EXPECT_THROW(CutFinder{rate}, std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::image
