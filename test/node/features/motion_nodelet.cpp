// The nodelet DominantMotion: tells the motion without a selection, and of a region; goes on after bad input.
#include <gtest/gtest.h>
#include <ros/ros.h>

#include "feature_bench.h"
#include "support/synthetic_motion.h"

namespace laparoscope_servo {
namespace {

using test_support::DiagnosticsListener;
using test_support::FeatureBench;
using test_support::Inbox;
using test_support::waitFor;

const char* const kKind = "motion";

// The scene goes to and fro, by 2 px each image.
cv::Mat movingScene(unsigned number) {
  static const cv::Mat scene = test::tissue({test::kMotionWidth, test::kMotionHeight}, 3);
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g(0, 2) = number % 2 == 0 ? 2.0 : 0.0;
  return test::view(scene, g, 1.0, 0.0, 2.0, number);
}

class MotionNodelet : public testing::Test {
 protected:
  struct Bench : FeatureBench {
    Bench() : FeatureBench({kKind}, movingScene) {}
    Inbox<sensor_msgs::Image> masks{node(), "motion/mask"};
  };
  static Bench& bench() {
    static Bench bench;
    return bench;
  }

  void SetUp() override {
    ASSERT_TRUE(bench().ready() && waitFor([] { return bench().masks.connected(); }));
    ASSERT_TRUE(bench().settle(kKind)) << "the nodelet does not answer";
    ASSERT_TRUE(bench().reset(kKind));
  }

  // Null when the image is refused.
  static TrackedFeaturesConstPtr send(const cv::Mat& image) {
    return bench().track(kKind, image, FeatureBench::nextStamp(), 0.5);
  }
  static TrackedFeaturesConstPtr trackUntil(std::uint8_t state) { return bench().trackUntil(kKind, state); }
  static SelectFeatures::Response select(const std::string& text) { return bench().select(kKind, text); }
};

TEST_F(MotionNodelet, TellsTheMotionWithoutASelection) {
  const TrackedFeaturesConstPtr told = trackUntil(TrackedFeatures::TRACKING);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->header.frame_id, "optical_of_the_test");
  ASSERT_EQ(told->features.size(), 1u);
  const TrackedFeature& motion = told->features[0];
  EXPECT_EQ(motion.kind, TrackedFeature::MOTION);
  ASSERT_EQ(motion.parameters.size(), 8u);
  ASSERT_EQ(motion.covariance.size(), 64u);
  // Pictures may be missed on the way: the scene was here or there before.
  EXPECT_NEAR(std::abs(std::abs(motion.parameters[0]) - 1.0), 1.0, 0.1);
  EXPECT_NEAR(motion.parameters[1], 0.0, 0.1);
  const sensor_msgs::ImageConstPtr mask = bench().masks.waitFor(told->header.stamp);
  ASSERT_TRUE(mask);
  EXPECT_EQ(mask->encoding, "mono8");
  EXPECT_EQ(mask->data.size(), static_cast<std::size_t>(test::kMotionWidth * test::kMotionHeight));
}

TEST_F(MotionNodelet, TellsTheMotionOfARegion) {
  const SelectFeatures::Response answer = select("[{id: liver, motion: [[60, 40], [260, 200]]}]");
  ASSERT_TRUE(answer.success) << answer.message;
  const TrackedFeaturesConstPtr told = trackUntil(TrackedFeatures::TRACKING);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->features.at(0).id, "liver");
}

TEST_F(MotionNodelet, RefusesAWrongSelectionAndGoesOn) {
  EXPECT_NE(select("[{id: dot, point: [9, 9]}]").message.find("expected motion of this tracker"), std::string::npos);
  EXPECT_NE(select("[{id: small, motion: [[9, 9], [12, 12]]}]").message.find("small: region of 4 x 4 px"),
            std::string::npos);
  EXPECT_TRUE(trackUntil(TrackedFeatures::TRACKING));
}

TEST_F(MotionNodelet, SaysWhyThereIsNoMotion) {
  ASSERT_TRUE(trackUntil(TrackedFeatures::TRACKING));
  TrackedFeaturesConstPtr told;
  cv::Mat white(test::kMotionHeight, test::kMotionWidth, CV_8UC3, cv::Scalar::all(255));
  ASSERT_TRUE(waitFor([&] { return (told = send(white)) != nullptr; }));
  EXPECT_EQ(told->state, TrackedFeatures::SEARCHING);
  EXPECT_NE(told->reason.find("highlight"), std::string::npos) << told->reason;
  EXPECT_TRUE(trackUntil(TrackedFeatures::TRACKING));
}

TEST_F(MotionNodelet, RefusesAnImageOfAnotherSizeAndGoesOn) {
  DiagnosticsListener diagnostics(bench().node(), "scope/motion");
  ASSERT_TRUE(trackUntil(TrackedFeatures::TRACKING));
  const TrackedFeaturesConstPtr told = send(cv::Mat(120, 160, CV_8UC3, cv::Scalar(90, 90, 90)));
  ASSERT_TRUE(told);
  EXPECT_EQ(told->state, TrackedFeatures::SEARCHING);
  EXPECT_TRUE(diagnostics.waitForMessage(diagnostic_msgs::DiagnosticStatus::ERROR, "image refused"))
      << diagnostics.last();
  EXPECT_TRUE(trackUntil(TrackedFeatures::TRACKING));
}

TEST_F(MotionNodelet, BeginsAnewWhenTimeJumpsBack) {
  const TrackedFeaturesConstPtr before = trackUntil(TrackedFeatures::TRACKING);
  ASSERT_TRUE(before);
  ros::Time stamp = FeatureBench::nextStamp() - ros::Duration(500.0);
  TrackedFeaturesConstPtr told;
  EXPECT_TRUE(waitFor([&] {
    stamp += ros::Duration(0.04);
    told = bench().track(kKind, bench().picture(), stamp, 0.5);
    return told && told->state == TrackedFeatures::TRACKING && told->header.stamp < before->header.stamp;
  }));
}

TEST_F(MotionNodelet, AFrozenPictureIsNotTracked) {
  ASSERT_TRUE(trackUntil(TrackedFeatures::TRACKING));
  const cv::Mat frozen = bench().picture();
  TrackedFeaturesConstPtr told;
  EXPECT_TRUE(waitFor([&] {
    told = send(frozen);
    return told && told->state == TrackedFeatures::SEARCHING;
  }));
  EXPECT_TRUE(trackUntil(TrackedFeatures::TRACKING));
}

TEST_F(MotionNodelet, DoesNotStartWithAWrongParameter) {
  DiagnosticsListener diagnostics(bench().node(), "wrong/motion");
  EXPECT_TRUE(diagnostics.waitForMessage(diagnostic_msgs::DiagnosticStatus::ERROR, "tracking/model"))
      << diagnostics.last();
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "motion_nodelet_test");
}
