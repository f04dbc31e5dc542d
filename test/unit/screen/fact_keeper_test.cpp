#include "screen/fact_keeper.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace laparoscope_servo::screen {
namespace {

sensor_msgs::Image preview(double stamp, std::uint8_t value, const std::string& encoding = "bgr8") {
  sensor_msgs::Image image;
  image.header.stamp = ros::Time(stamp);
  image.width = 5;
  image.height = 3;
  image.encoding = encoding;
  image.step = encoding == "mono8" ? 7 : 17;  // padded
  image.data.assign(image.step * image.height, value);
  return image;
}

Homography homography(double stamp) {
  Homography message;
  message.header.stamp = ros::Time(stamp);
  message.state = Homography::TRACKING;
  message.corners[0] = stamp;
  return message;
}

AreaSelection areas(double stamp) {
  AreaSelection message;
  message.header.stamp = ros::Time(stamp);
  message.rows = 2;
  message.columns = 3;
  message.occluded = {1, 0, 0, 0, 0, 1};
  return message;
}

TEST(FactKeeper, KnowsWhenTheNewestResultCame) {
  FactKeeper keeper;
  keeper.takeRecorded(homography(9.9));
  EXPECT_EQ(keeper.facts().tracker.result_at, kNever) << "one that was recorded is none of the tracker that runs";
  keeper.take(homography(10.0), 0.02, 100.0);
  EXPECT_EQ(keeper.facts().tracker.result_at, 100.0);
}

TEST(FactKeeper, FindsTheResultOfThePicturesOwnImage) {
  FactKeeper keeper;
  for (const double stamp : {10.0, 10.1, 10.2, 10.3}) keeper.take(homography(stamp), 0.01, 1.0);
  keeper.take(areas(10.1));
  keeper.take(preview(10.1, 7), 0.0, 1.0);
  ASSERT_TRUE(keeper.facts().result);
  EXPECT_EQ(keeper.facts().result->corners[0], 10.1);
  ASSERT_TRUE(keeper.facts().areas);
  EXPECT_TRUE(keeper.facts().areas->covered[5]);
}

TEST(FactKeeper, AResultMayComeLaterThanItsPicture) {
  FactKeeper keeper;
  keeper.take(homography(10.0), 0.01, 1.0);
  keeper.take(preview(10.1, 7), 0.0, 1.0);
  EXPECT_FALSE(keeper.facts().result) << "that of another image is not drawn over it";
  keeper.take(homography(10.1), 0.01, 1.0);
  ASSERT_TRUE(keeper.facts().result);
  EXPECT_EQ(keeper.facts().result->corners[0], 10.1);
}

TEST(FactKeeper, TellsWhetherFeaturesAreOfThePictureThatIsShown) {
  FactKeeper keeper;
  keeper.take(preview(10.1, 7), 0.0, 1.0);
  TrackedFeatures message;
  message.header.stamp = ros::Time(10.0);
  EXPECT_FALSE(keeper.take("edges", message, 2.0));
  message.header.stamp = ros::Time(10.1);
  EXPECT_TRUE(keeper.take("edges", message, 2.0));
  message.header.stamp = ros::Time(10.2);
  EXPECT_FALSE(keeper.take("edges", message, 2.0));
  keeper.setFeatureTrackers({{"edges", true}});
  ASSERT_EQ(keeper.facts().features.size(), 1u);
  EXPECT_TRUE(keeper.facts().features[0].connected);
  EXPECT_EQ(keeper.facts().features[0].drawn->stamp, 10100000000);
  keeper.take(preview(10.2, 8), 0.0, 1.0);
  EXPECT_EQ(keeper.facts().features[0].drawn->stamp, 10200000000) << "it came before its picture";
}

TEST(FactKeeper, WhatWasRecordedStandsBesideWhatIsComputedNow) {
  FactKeeper keeper;
  keeper.take(homography(10.1), 0.01, 1.0);
  Homography recorded = homography(10.1);
  recorded.corners[0] = 3.0;
  keeper.takeRecorded(homography(10.0));
  keeper.takeRecorded(recorded);
  keeper.take(preview(10.1, 7), 0.0, 1.0);
  ASSERT_TRUE(keeper.facts().recorded);
  EXPECT_EQ(keeper.facts().recorded->corners[0], 3.0);
  EXPECT_EQ(keeper.facts().result->corners[0], 10.1);
  keeper.take(preview(10.2, 8), 0.0, 1.0);
  EXPECT_FALSE(keeper.facts().recorded);
}

TEST(FactKeeper, TellsPicturesThatRepeat) {
  FactKeeper keeper;
  keeper.take(preview(10.0, 7), 0.0, 1.0);
  keeper.take(preview(10.1, 7), 0.0, 1.1);
  EXPECT_EQ(keeper.facts().picture.changed_at, 1.0);
  EXPECT_EQ(keeper.facts().picture.arrived_at, 1.1);
  keeper.take(preview(10.2, 8), 0.0, 1.2);
  EXPECT_EQ(keeper.facts().picture.changed_at, 1.2);
}

TEST(FactKeeper, TakesColourAndGrey) {
  FactKeeper keeper;
  sensor_msgs::Image image = preview(10.0, 0);
  image.data[0] = 10;        // blue of the first pixel
  image.data[17 + 2] = 200;  // red of the second row's
  keeper.take(image, 0.0, 1.0);
  EXPECT_EQ(keeper.facts().picture.image.size(), QSize(5, 3));
  EXPECT_EQ(keeper.facts().picture.image.pixel(0, 0), qRgb(0, 0, 10));
  EXPECT_EQ(keeper.facts().picture.image.pixel(0, 1), qRgb(200, 0, 0));
  keeper.take(preview(10.1, 9, "mono8"), 0.0, 1.1);
  EXPECT_EQ(keeper.facts().picture.image.pixel(4, 2), qRgb(9, 9, 9));
}

TEST(FactKeeper, NothingThatATopicCarriesHarms) {
  FactKeeper keeper;
  keeper.take(preview(10.0, 7), 0.0, 1.0);
  std::vector<sensor_msgs::Image> bad(7, preview(11.0, 8));
  bad[0].encoding = "bayer_rggb8";
  bad[1].width = 0;
  bad[2].height = 4000000000u;
  bad[3].step = 1;
  bad[4].data.resize(20);
  bad[5].width = 1000;
  bad[6].step = 0;
  for (const sensor_msgs::Image& image : bad) keeper.take(image, 0.0, 2.0);
  EXPECT_EQ(keeper.facts().picture.arrived_at, 1.0) << "the one before grows old";
  AreaSelection odd = areas(10.0);
  odd.rows = 60000;
  keeper.take(odd);
  ASSERT_TRUE(keeper.facts().areas);
  EXPECT_EQ(keeper.facts().areas->rows, 0);
  TrackerState state;
  state.width = state.height = 4000000000u;
  state.proposal.width = 4000000000u;
  keeper.take(state, 1.0);
  EXPECT_EQ(keeper.facts().tracker.width, 0);
  keeper.take(preview(12.0, 1), std::numeric_limits<double>::quiet_NaN(), 3.0);
  EXPECT_EQ(keeper.facts().picture.age_at_arrival, 0.0);
}

TEST(FactKeeper, ThePictureOfATrackerOfFeaturesHasTheSizeOfItsImages) {
  FactKeeper keeper;
  keeper.take("edges", preview(10.0, 1), 0.0, 1.0);
  EXPECT_TRUE(keeper.facts().picture.original.isEmpty()) << "not known yet";
  TrackedFeatures features;
  features.width = 1920;
  features.height = 1080;
  keeper.take("edges", features, 1.0);
  keeper.take("edges", preview(11.0, 1), 0.0, 1.0);
  EXPECT_EQ(keeper.facts().picture.original, QSize(1920, 1080));
  keeper.take(preview(12.0, 1), 0.0, 1.0);
  EXPECT_TRUE(keeper.facts().picture.original.isEmpty()) << "the region tracker says it in its state";
}

TEST(FactKeeper, KeepsTheRegionThatTheTrackerProposes) {
  FactKeeper keeper;
  TrackerState state;
  state.proposal.x_offset = 12;
  state.proposal.y_offset = 34;
  state.proposal.width = 56;
  state.proposal.height = 78;
  keeper.take(state, 1.0);
  EXPECT_EQ(keeper.facts().tracker.proposal, QRect(12, 34, 56, 78));
}

}  // namespace
}  // namespace laparoscope_servo::screen
