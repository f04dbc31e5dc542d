#include "ros/playback/recorded_results.h"

#include <gtest/gtest.h>
#include <std_msgs/String.h>

#include <array>
#include <cmath>
#include <fstream>
#include <string>

#include "ros/playback/corners_apart.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

constexpr int kImages = 500;  // at 25 Hz: 20 s

ros::Time stampOf(int k) {
  return ros::Time(50.0) + ros::Duration(0.04 * k);
}
ros::Time timeOf(int k) {
  return stampOf(k) + ros::Duration(1000.0);  // the recorder's clock
}

class RecordedResultsTest : public testing::Test {
 protected:
  // Each result comes 0.1 s after its image, and tells the image's number.
  std::string writeBag(const std::string& name, const std::vector<std::string>& topics, int from = 0,
                       int to = kImages) {
    rosbag::Bag bag(folder_.file(name), rosbag::bagmode::Write);
    bag.write("/chatter", timeOf(from), std_msgs::String());
    for (int k = from; k < to; ++k) {
      Homography result;
      result.header.stamp = stampOf(k);
      result.iterations = static_cast<std::uint16_t>(k);
      for (const std::string& topic : topics) bag.write(topic, timeOf(k) + ros::Duration(0.1), result);
    }
    return folder_.file(name);
  }
  static int numberAt(RecordedResults& results, int k) {
    const HomographyConstPtr result = results.at(stampOf(k), timeOf(k));
    return result ? result->iterations : -1;
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(RecordedResultsTest, FindsToEachImageItsOwn) {
  RecordedResults results({writeBag("case.bag", {"/tracker/homography"})}, "");
  EXPECT_TRUE(results.any());
  EXPECT_EQ(results.topic(), "/tracker/homography");
  for (int k = 0; k < kImages; ++k) ASSERT_EQ(numberAt(results, k), k);
}

TEST_F(RecordedResultsTest, FindsItAfterEveryJump) {
  RecordedResults results({writeBag("case.bag", {"/tracker/homography"})}, "");
  for (const int k : {400, 401, 0, 499, 3, 120, 119, 60, 5}) EXPECT_EQ(numberAt(results, k), k);
}

TEST_F(RecordedResultsTest, OfAnImageWithoutOneThereIsNone) {
  RecordedResults results({writeBag("case.bag", {"/tracker/homography"}, 10, 20)}, "");
  EXPECT_EQ(numberAt(results, 5), -1);
  EXPECT_EQ(numberAt(results, 15), 15);
  EXPECT_EQ(numberAt(results, 20), -1);
  EXPECT_FALSE(results.at(stampOf(15) + ros::Duration(0.001), timeOf(15)));
  EXPECT_EQ(numberAt(results, 4000), -1);
  EXPECT_FALSE(results.at(ros::Time(), ros::Time()));
}

TEST_F(RecordedResultsTest, SeveralBagsAreOneRecording) {
  const std::string first = writeBag("1.bag", {"/tracker/homography"}, 0, 250);
  RecordedResults results({first, writeBag("2.bag", {"/tracker/homography"}, 250, 500)}, "");
  for (int k = 240; k < 260; ++k) ASSERT_EQ(numberAt(results, k), k);
}

TEST_F(RecordedResultsTest, OfTwoCartsTheOneOfTheImages) {
  const std::string bag = writeBag("case.bag", {"/left/tracker/homography", "/right/tracker/homography"}, 0, 5);
  EXPECT_EQ(RecordedResults({bag}, "/left/camera/image_raw").topic(), "/left/tracker/homography");
  EXPECT_EQ(RecordedResults({bag}, "right/camera/image_raw").topic(), "/right/tracker/homography");
  EXPECT_FALSE(RecordedResults({bag}, "/camera/image_raw").any()) << "nobody can tell which";
  const std::string three = writeBag("three.bag", {"/a/homography", "/b/homography", "/c/homography"}, 0, 5);
  EXPECT_FALSE(RecordedResults({three}, "").any());
  EXPECT_EQ(RecordedResults({three}, "/b/image").topic(), "/b/homography");
}

TEST_F(RecordedResultsTest, WhatHasNoneHasNone) {
  EXPECT_FALSE(RecordedResults({writeBag("case.bag", {})}, "").any());
  EXPECT_FALSE(RecordedResults({folder_.path()}, "").any());
  EXPECT_FALSE(RecordedResults({folder_.file("no.bag")}, "").any());
  std::ofstream(folder_.file("film.mp4")) << "no bag";
  RecordedResults film({folder_.file("film.mp4")}, "");
  EXPECT_FALSE(film.any());
  EXPECT_EQ(numberAt(film, 0), -1);
}

TEST(CornersApart, IsThatOfTheWorstCorner) {
  const std::array<double, 8> square{0, 0, 10, 0, 10, 10, 0, 10};
  EXPECT_EQ(cornersApart(square, square), 0.0);
  EXPECT_EQ(cornersApart(square, std::array<double, 8>{0, 1, 10, 0, 13, 14, 0, 10}), 5.0);
  EXPECT_TRUE(std::isnan(cornersApart(square, std::array<double, 8>{0, NAN, 10, 0, 13, 14, 0, 10})));
}

}  // namespace
}  // namespace laparoscope_servo
