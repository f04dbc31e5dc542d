#include "ros/tracker/tracker_state_report.h"

#include <gtest/gtest.h>

namespace laparoscope_servo {
namespace {

Processed image(double stamp, tracking::State state, const std::string& reason = "") {
  Processed processed;
  processed.header.stamp = ros::Time(stamp);
  processed.image = cv::Mat(240, 320, CV_8UC1, cv::Scalar(0));
  processed.result.state = state;
  processed.result.reason = reason;
  processed.result.roi = {100.0, 70.0, 40.0, 30.0};
  processed.reference_stamp = ros::Time(90.0);
  return processed;
}

TEST(TrackerStateReport, SaysTheFirstImageAndEachChangeAtOnce) {
  TrackerStateReport report;
  const auto first = report.processed(0.0, image(100.0, tracking::State::kIdle, "no region of interest selected"));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->state, TrackerState::IDLE);
  EXPECT_EQ(first->reason, "no region of interest selected");
  EXPECT_EQ(first->width, 320u);
  EXPECT_EQ(first->height, 240u);
  EXPECT_EQ(first->reference_stamp, ros::Time());
  EXPECT_EQ(first->region[4], 0.0) << "no region is shown while there is none";

  const auto tracking = report.processed(0.02, image(100.02, tracking::State::kTracking));
  ASSERT_TRUE(tracking);
  EXPECT_EQ(tracking->state, TrackerState::TRACKING);
  EXPECT_EQ(tracking->since, ros::Time(100.02));
  EXPECT_EQ(tracking->reference_stamp, ros::Time(90.0));
  EXPECT_EQ(tracking->region[0], 100.0);
  EXPECT_EQ(tracking->region[5], 99.0) << "centre of the last row";

  EXPECT_FALSE(report.processed(0.04, image(100.04, tracking::State::kTracking))) << "nothing has changed";
  Processed other_region = image(100.06, tracking::State::kTracking);
  other_region.reference_stamp = ros::Time(100.06);
  const auto selected = report.processed(0.06, other_region);
  ASSERT_TRUE(selected);
  EXPECT_EQ(selected->since, ros::Time(100.02)) << "it tracks since then";
  other_region.proposal = geometry::Rectangle{20.0, 30.0, 50.0, 60.0};
  const auto proposed = report.processed(0.065, other_region);
  ASSERT_TRUE(proposed);
  EXPECT_EQ(proposed->proposal.y_offset, 30u);
  EXPECT_EQ(proposed->proposal.width, 50u);
  other_region.proposal = geometry::Rectangle{-2.0, 30.0, 50.0, 60.0};
  const auto rectified = report.processed(0.07, other_region);
  ASSERT_TRUE(rectified);
  EXPECT_EQ(rectified->proposal.width, 0u) << "the message cannot say it";
  other_region.recall = "going to view 'a'";
  ASSERT_TRUE(report.processed(0.08, other_region));
  other_region.image = cv::Mat(480, 640, CV_8UC1, cv::Scalar(0));
  EXPECT_TRUE(report.processed(0.10, other_region));
}

TEST(TrackerStateReport, AReasonThatChangesWithEachImageIsSaidAFewTimesASecond) {
  TrackerStateReport report;
  int said = 0;
  for (int k = 0; k < 100; ++k) {
    const std::string reason = "visible fraction 0." + std::to_string(k);
    if (report.processed(0.01 * k, image(100.0 + 0.01 * k, tracking::State::kSearching, reason))) ++said;
  }
  EXPECT_EQ(said, 5);
}

TEST(TrackerStateReport, SaysOnceASecondThatNothingHasChanged) {
  TrackerStateReport report;
  int said = 0;
  for (int k = 0; k <= 400; ++k) {
    if (report.processed(0.01 * k, image(100.0 + 0.01 * k, tracking::State::kTracking))) ++said;
    if (k % 20 == 0 && report.tick(0.01 * k)) ++said;
  }
  EXPECT_GE(said, 4);
  EXPECT_LE(said, 5);
}

TEST(TrackerStateReport, AStateDoesNotOutliveTheImages) {
  TrackerStateReport report;
  report.processed(0.0, image(100.0, tracking::State::kTracking));
  EXPECT_FALSE(report.tick(0.9));
  const auto silent = report.tick(1.1);
  ASSERT_TRUE(silent);
  EXPECT_EQ(silent->state, TrackerState::NO_IMAGE);
  EXPECT_EQ(silent->reason, "no image for more than 1 s; before: TRACKING");
  EXPECT_EQ(silent->since, ros::Time(100.0));
  EXPECT_EQ(silent->width, 320u);
  EXPECT_FALSE(report.tick(1.3)) << "it was said";
  EXPECT_TRUE(report.tick(2.2)) << "once a second";
  const auto back = report.processed(2.3, image(102.3, tracking::State::kTracking));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->state, TrackerState::TRACKING);
  EXPECT_EQ(back->since, ros::Time(102.3));
}

TEST(TrackerStateReport, SaysWhatIsWrongWithImagesThatCannotBeUsed) {
  TrackerStateReport report;
  EXPECT_FALSE(report.tick(0.0));
  EXPECT_FALSE(report.tick(0.9)) << "the first image may be on its way";
  const auto none = report.tick(1.2);
  ASSERT_TRUE(none);
  EXPECT_EQ(none->reason, "no image has come yet");
  report.refused(1.5, "image has encoding 'bayer_rggb8'");
  const auto refused = report.tick(1.6);
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->state, TrackerState::NO_IMAGE);
  EXPECT_EQ(refused->reason, "image refused: image has encoding 'bayer_rggb8'");
  report.processed(2.0, image(100.0, tracking::State::kTracking));
  report.refused(2.1, "image has encoding 'bayer_rggb8'");
  EXPECT_FALSE(report.tick(2.2)) << "one among others changes nothing";
}

TEST(TrackerStateReport, WhatIsWrongWithImagesDoesNotOutliveThem) {
  TrackerStateReport report;
  report.tick(0.0);
  report.refused(1.5, "image has encoding 'bayer_rggb8'");
  ASSERT_EQ(report.tick(1.6)->reason, "image refused: image has encoding 'bayer_rggb8'");
  const auto silent = report.tick(2.7);
  ASSERT_TRUE(silent);
  EXPECT_EQ(silent->reason, "no image for more than 1 s; before: images that were refused");
}

// The tracker says it for one image only.
TEST(TrackerStateReport, WhyTheRegionIsGoneStaysUntilAnotherOneIsSelected) {
  TrackerStateReport report;
  const auto reason = [&](double now, tracking::State state, const std::string& why) {
    const auto message = report.processed(now, image(100.0 + now, state, why));
    return message ? message->reason : "";
  };
  reason(0.0, tracking::State::kTracking, "");
  const std::string gone = "image size changed from 640 x 480 to 320 x 240 px: select the ROI again";
  EXPECT_EQ(reason(1.0, tracking::State::kIdle, gone), gone);
  EXPECT_EQ(reason(2.5, tracking::State::kIdle, "no region of interest selected"), gone);
  EXPECT_EQ(report.tick(4.0)->reason, "no image for more than 1 s; before: IDLE: " + gone);
  EXPECT_EQ(reason(5.0, tracking::State::kTracking, ""), "");
  EXPECT_EQ(reason(6.0, tracking::State::kIdle, "no region of interest selected"), "no region of interest selected");
}

}  // namespace
}  // namespace laparoscope_servo
