#include "ros/tracker/tracker_session.h"

#include <cv_bridge/cv_bridge.h>
#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <stdexcept>
#include <string>

#include "ros/tracker/image_conversion.h"
#include "ros/tracker/result_messages.h"
#include "support/stamped_header.h"
#include "support/synthetic_sequence.h"
#include "tracking/align/region_aligner.h"

namespace laparoscope_servo {
namespace {

using test_support::at;
using tracking::State;

const cv::Size kSize(320, 240);
const geometry::Rectangle kRoi{100.0, 70.0, 100.0, 90.0};

TrackerParameters withRoi() {
  TrackerParameters parameters;
  parameters.roi = kRoi;
  return parameters;
}

sensor_msgs::CameraInfo cameraInfo() {
  sensor_msgs::CameraInfo info;
  info.K = {300.0, 0.0, 160.0, 0.0, 300.0, 120.0, 0.0, 0.0, 1.0};
  return info;
}

class TrackerSessionTest : public testing::Test {
 protected:
  cv::Mat picture() { return test_support::noisy(image_, random_); }

  cv::RNG random_{3};
  const cv::Mat image_ = test_support::texture(kSize);
};

TEST_F(TrackerSessionTest, IsIdleUntilARoiIsRequested) {
  TrackerSession session{TrackerParameters()};
  EXPECT_EQ(session.process(picture(), at(1.0)).result.state, State::kIdle);
  const Processed selected = session.process(picture(), at(2.0), kRoi);
  EXPECT_EQ(selected.result.state, State::kTracking);
  EXPECT_TRUE(selected.result.selected_now);
  EXPECT_EQ(selected.reference_stamp, ros::Time(2.0));
  const Processed next = session.process(picture(), at(3.0));
  EXPECT_EQ(next.result.state, State::kTracking);
  EXPECT_FALSE(next.result.selected_now);
  EXPECT_EQ(next.reference_stamp, ros::Time(2.0));
  EXPECT_EQ(next.header.frame_id, "optical");
  EXPECT_EQ(next.header.stamp, ros::Time(3.0));
}

TEST_F(TrackerSessionTest, StartsByItselfWithTheParametersRoi) {
  TrackerSession session(withRoi());
  EXPECT_TRUE(session.process(image_, at(1.0)).result.selected_now);
}

TEST_F(TrackerSessionTest, FollowsKnownMotion) {
  TrackerSession session(withRoi());
  const auto motion = test_support::motion(20, kRoi, 8.0);
  for (std::size_t k = 0; k < motion.size(); ++k) {
    const Processed processed =
        session.process(test_support::view(image_, motion[k]), at(0.04 * static_cast<double>(k)));
    ASSERT_EQ(processed.result.state, State::kTracking) << k << ": " << processed.result.reason;
    EXPECT_LT(geometry::cornerDistance(processed.result.g, motion[k], kRoi), 0.5) << k;
    EXPECT_NEAR(processed.result.g.determinant(), 1.0, 1e-9);
  }
}

TEST_F(TrackerSessionTest, WaitsForAnImageInWhichTheParametersRoiCanBeSelected) {
  TrackerSession session(withRoi());
  const Processed black = session.process(cv::Mat::zeros(kSize, CV_8UC3), at(1.0));
  EXPECT_EQ(black.result.state, State::kIdle);
  EXPECT_NE(black.selection_error, "");
  EXPECT_NE(black.result.reason.find(black.selection_error), std::string::npos);
  EXPECT_TRUE(session.process(image_, at(2.0)).result.selected_now);
  EXPECT_EQ(session.process(image_, at(3.0)).selection_error, "");
}

TEST_F(TrackerSessionTest, KeepsTheOldRoiWhenANewOneIsRefused) {
  TrackerSession session(withRoi());
  session.process(image_, at(1.0));
  const Processed refused = session.process(image_, at(2.0), geometry::Rectangle{300.0, 200.0, 100.0, 100.0});
  EXPECT_NE(refused.selection_error, "");
  EXPECT_EQ(refused.result.state, State::kTracking);
  EXPECT_EQ(refused.reference_stamp, ros::Time(1.0));
}

TEST_F(TrackerSessionTest, ForgetsEveryRoiWhenReset) {
  TrackerSession session(withRoi());
  session.process(image_, at(10.0));
  session.reset();
  EXPECT_EQ(session.process(image_, at(11.0)).result.state, State::kIdle);
  session.clockJumpedBack();
  EXPECT_EQ(session.process(image_, at(1.0)).result.state, State::kIdle);
}

TEST_F(TrackerSessionTest, GoesOnAsIfABadImageHadNotCome) {
  TrackerSession session(withRoi());
  session.process(image_, at(1.0));
  sensor_msgs::Image truncated = *cv_bridge::CvImage(at(0.5), "bgr8", image_).toImageMsg();
  truncated.data.resize(100);
  EXPECT_THROW(session.process(truncated), ImageError);
  EXPECT_THROW(session.process(cv::Mat(), at(0.5)), ImageError);
  // A stamp of 0.5 would have been a jump back.
  EXPECT_EQ(session.process(image_, at(2.0)).result.state, State::kTracking);
}

TEST_F(TrackerSessionTest, GivesTheSameNumbersForEveryEncodingOfAnImage) {
  const auto g = test_support::motion(8, kRoi, 6.0)[1];
  const cv::Mat moved = test_support::view(image_, g);
  TrackerSession bgr(withRoi());
  bgr.process(image_, at(1.0));
  const Processed expected = bgr.process(moved, at(1.04));
  for (const std::string encoding : {"bgr8", "rgb8", "bgra8", "rgba8", "bgr16", "rgb16"}) {
    TrackerSession session(withRoi());
    Processed processed;
    for (const cv::Mat& image : {image_, moved}) {
      const double stamp = image.data == image_.data ? 1.0 : 1.04;
      cv_bridge::CvImage bridge(at(stamp), "bgr8", image);
      processed =
          session.process(*cv_bridge::cvtColor(boost::make_shared<cv_bridge::CvImage>(bridge), encoding)->toImageMsg());
    }
    EXPECT_EQ(processed.result.g, expected.result.g) << encoding;
  }
}

TEST_F(TrackerSessionTest, TracksGreyImages) {
  cv::Mat grey;
  cv::cvtColor(image_, grey, cv::COLOR_BGR2GRAY);
  TrackerSession session(withRoi());
  session.process(*cv_bridge::CvImage(at(1.0), "mono8", grey).toImageMsg());
  const auto g = test_support::motion(8, kRoi, 6.0)[1];
  const Processed processed =
      session.process(*cv_bridge::CvImage(at(1.04), "mono8", test_support::view(grey, g)).toImageMsg());
  EXPECT_EQ(processed.result.state, State::kTracking);
  EXPECT_FALSE(processed.result.colour_used);
}

TEST_F(TrackerSessionTest, HasACameraOnlyWhileItIsTheReferences) {
  TrackerSession session(withRoi());
  EXPECT_FALSE(session.process(picture(), at(1.0)).camera);
  session.setCameraInfo(cameraInfo());
  const Processed late = session.process(picture(), at(2.0));
  ASSERT_TRUE(late.camera);
  EXPECT_TRUE(taskErrorMessage(late).valid);
  sensor_msgs::CameraInfo zoomed = cameraInfo();
  zoomed.K[0] = zoomed.K[4] = 450.0;
  session.setCameraInfo(zoomed);
  const Processed changed = session.process(picture(), at(3.0));
  EXPECT_FALSE(changed.camera);
  EXPECT_NE(changed.camera_error.find("changed"), std::string::npos);
  EXPECT_EQ(changed.result.state, State::kTracking);
  EXPECT_FALSE(taskErrorMessage(changed).valid);
  EXPECT_TRUE(session.process(picture(), at(4.0), kRoi).camera);
}

TEST_F(TrackerSessionTest, HasAMaskOfTheImagesSizeInEveryState) {
  TrackerSession session{TrackerParameters()};
  session.process(image_, at(1.0));
  EXPECT_EQ(session.occlusionMask().size(), kSize);
  EXPECT_EQ(cv::countNonZero(session.occlusionMask()), 0);
  session.process(image_, at(2.0), kRoi);
  cv::Mat covered = image_.clone();
  cv::rectangle(covered, cv::Rect(100, 70, 50, 90), cv::Scalar(200, 30, 30), cv::FILLED);
  session.process(covered, at(2.04));
  const cv::Mat mask = session.occlusionMask();
  ASSERT_EQ(mask.type(), CV_8UC1);
  ASSERT_EQ(mask.size(), kSize);
  EXPECT_GT(cv::countNonZero(mask(cv::Rect(104, 74, 40, 80))), 40 * 80 / 2);
  EXPECT_EQ(cv::countNonZero(mask(cv::Rect(0, 0, 90, 240))), 0);
}

TEST_F(TrackerSessionTest, RefusesParametersOutOfRange) {
  TrackerParameters parameters;
  parameters.tracking.esm.levels = 0;
  EXPECT_THROW(TrackerSession{parameters}, std::invalid_argument);
}

TEST_F(TrackerSessionTest, SaysWhatWouldDoWhereARegionIsRefused) {
  cv::Mat image(kSize, CV_8UC3, cv::Scalar(70, 80, 150));
  const cv::Rect textured(160, 60, 120, 120);
  image_(textured).copyTo(image(textured));
  TrackerSession session{TrackerParameters()};
  const std::string error = session.process(image, at(1.0), geometry::Rectangle{70, 80, 70, 70}).selection_error;
  EXPECT_NE(error.find("too little texture"), std::string::npos) << error;
  EXPECT_NE(error.find(" would do"), std::string::npos) << error;
}

// The first second is a region's trial.
TEST_F(TrackerSessionTest, SaysThatARegionWasNotHeldInItsFirstSecondUntilItIsTracked) {
  const cv::Mat other = test_support::view(test_support::texture(cv::Size(400, 300)), Eigen::Matrix3d::Identity());
  const cv::Mat elsewhere = other(cv::Rect(cv::Point(70, 50), kSize));
  TrackerSession session(withRoi());
  session.process(picture(), at(1.0));
  cv::Mat grain(kSize, CV_8UC3);
  std::string early, late;
  std::optional<geometry::Rectangle> proposal;
  for (int k = 1; k <= 40; ++k) {
    random_.fill(grain, cv::RNG::UNIFORM, 0, 2);
    const Processed processed = session.process(grain + elsewhere, at(1.0 + 0.04 * k));
    ASSERT_NE(processed.result.state, State::kTracking) << k;
    (k < 25 ? early : late) = processed.result.reason;
    EXPECT_EQ(processed.proposal.has_value(), k >= 25) << k;
    proposal = processed.proposal;
  }
  const std::string said = "it was not held in its first second";
  EXPECT_EQ(early.find(said), std::string::npos) << early;
  EXPECT_NE(late.find(said), std::string::npos) << late;
  const auto reference = session.reference();
  ASSERT_TRUE(reference);
  EXPECT_EQ(reference->stamp, ros::Time(1.0)) << "what is proposed lies in the image of the selection";
  ASSERT_TRUE(proposal) << late;
  EXPECT_NE(late.find(roiText(*proposal)), std::string::npos) << late;
  EXPECT_NO_THROW(tracking::RegionTracker(tracking::TrackerConfig()).check(reference->image, *proposal));
  Processed processed;
  for (int k = 41; k <= 80 && processed.result.state != State::kTracking; ++k)
    processed = session.process(picture(), at(1.0 + 0.04 * k));
  EXPECT_EQ(processed.result.state, State::kTracking);
  EXPECT_EQ(processed.result.reason, "");
  EXPECT_FALSE(processed.proposal);
  for (int k = 81; k <= 90; ++k) processed = session.process(grain + elsewhere, at(1.0 + 0.04 * k));
  EXPECT_NE(processed.result.state, State::kTracking);
  EXPECT_EQ(processed.result.reason.find(said), std::string::npos) << processed.result.reason;
}

TEST_F(TrackerSessionTest, SaysNothingOfARegionThatWasHeldOrIsCovered) {
  TrackerSession session(withRoi());
  for (int k = 0; k <= 30; ++k) session.process(picture(), at(1.0 + 0.04 * k));
  TrackerSession covered(withRoi());
  covered.process(picture(), at(1.0));
  const cv::Mat blue(kSize, CV_8UC3, cv::Scalar(200, 60, 30));
  cv::Mat grain(kSize, CV_8UC3);
  for (int k = 1; k <= 30; ++k) {
    random_.fill(grain, cv::RNG::UNIFORM, 0, 2);
    const double stamp = 0.04 * k;
    const Processed lost = session.process(grain + blue, at(2.2 + stamp));
    EXPECT_EQ(lost.result.reason.find("first second"), std::string::npos) << lost.result.reason;
    const Processed hidden = covered.process(grain + blue, at(1.0 + stamp));
    EXPECT_EQ(hidden.result.reason.find("first second"), std::string::npos) << hidden.result.reason;
  }
}

}  // namespace
}  // namespace laparoscope_servo
