// The nodelet DominantMotion: tells the motion without a selection, and of a region; goes on after bad input.
#include <gtest/gtest.h>
#include <laparoscope_servo/SelectFeatures.h>
#include <laparoscope_servo/TrackedFeatures.h>
#include <ros/ros.h>

#include <future>

#include "node/tracker/camera_bench.h"
#include "support/feature_scene.h"
#include "support/synthetic_motion.h"

namespace laparoscope_servo {
namespace {

using test_support::DiagnosticsListener;
using test_support::imageAt;
using test_support::Inbox;
using test_support::waitFor;

class MotionNodelet : public testing::Test {
 protected:
  struct Bench {
    ros::NodeHandle node{"scope"};
    ros::Publisher images = node.advertise<sensor_msgs::Image>("image", 1);
    Inbox<TrackedFeatures> features{node, "motion/features"};
    Inbox<sensor_msgs::Image> masks{node, "motion/mask"};
    cv::Mat scene = test::tissue({test::kMotionWidth, test::kMotionHeight}, 3);
    int image = 0;
    double time = 1000.0;
  };
  static Bench& bench() {
    static Bench bench;
    return bench;
  }

  void SetUp() override {
    ASSERT_TRUE(waitFor([] {
      return bench().images.getNumSubscribers() > 0 && bench().features.connected() && bench().masks.connected();
    }));
    ASSERT_TRUE(waitFor([this] { return track() != nullptr; })) << "the nodelet does not answer";
    std_srvs::Trigger call;
    ASSERT_TRUE(ros::service::call("/scope/motion/reset", call) && call.response.success);
  }

  // The scene goes to and fro, by 2 px each image; no two pictures repeat.
  cv::Mat picture() {
    const int k = ++bench().image;
    Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
    g(0, 2) = k % 2 == 0 ? 2.0 : 0.0;
    return test::view(bench().scene, g, 1.0, 0.0, 2.0, static_cast<unsigned>(k));
  }
  // Null when the image is refused.
  TrackedFeaturesConstPtr send(const cv::Mat& image, double patience = 20.0) {
    const sensor_msgs::ImagePtr message = imageAt(image, bench().time += 0.04);
    bench().images.publish(message);
    waitFor([&] { return bench().features.at(message->header.stamp) != nullptr; }, patience);
    return bench().features.at(message->header.stamp);
  }
  TrackedFeaturesConstPtr track() { return send(picture(), 0.5); }
  TrackedFeaturesConstPtr trackUntil(std::uint8_t state) {
    TrackedFeaturesConstPtr told;
    waitFor([&] { return (told = track()) != nullptr && told->state == state; });
    return told && told->state == state ? told : nullptr;
  }
  SelectFeatures::Response select(const std::string& text) {
    SelectFeatures call;
    call.request.selection = text;
    auto answer =
        std::async(std::launch::async, [&call] { return ros::service::call("/scope/motion/select_features", call); });
    while (answer.wait_for(std::chrono::milliseconds(5)) != std::future_status::ready) track();
    if (!answer.get()) call.response.message = "the service call failed";
    return call.response;
  }
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
  ASSERT_TRUE(waitFor([&] { return (told = send(white, 0.5)) != nullptr; }));
  EXPECT_EQ(told->state, TrackedFeatures::SEARCHING);
  EXPECT_NE(told->reason.find("highlight"), std::string::npos) << told->reason;
  EXPECT_TRUE(trackUntil(TrackedFeatures::TRACKING));
}

TEST_F(MotionNodelet, RefusesAnImageOfAnotherSizeAndGoesOn) {
  DiagnosticsListener diagnostics(bench().node, "scope/motion");
  ASSERT_TRUE(trackUntil(TrackedFeatures::TRACKING));
  EXPECT_FALSE(send(cv::Mat(120, 160, CV_8UC3, cv::Scalar(90, 90, 90)), 0.5));
  EXPECT_TRUE(diagnostics.waitForMessage(diagnostic_msgs::DiagnosticStatus::ERROR, "image refused"))
      << diagnostics.last();
  EXPECT_TRUE(trackUntil(TrackedFeatures::TRACKING));
}

TEST_F(MotionNodelet, BeginsAnewWhenTimeJumpsBack) {
  const TrackedFeaturesConstPtr before = trackUntil(TrackedFeatures::TRACKING);
  ASSERT_TRUE(before);
  bench().time -= 500.0;
  TrackedFeaturesConstPtr told;
  EXPECT_TRUE(waitFor([&] {
    told = track();
    return told && told->state == TrackedFeatures::TRACKING && told->header.stamp < before->header.stamp;
  }));
}

TEST_F(MotionNodelet, AFrozenPictureIsNotTracked) {
  ASSERT_TRUE(trackUntil(TrackedFeatures::TRACKING));
  const cv::Mat frozen = picture();
  TrackedFeaturesConstPtr told;
  EXPECT_TRUE(waitFor([&] {
    told = send(frozen, 0.5);
    return told && told->state == TrackedFeatures::SEARCHING;
  }));
  EXPECT_TRUE(trackUntil(TrackedFeatures::TRACKING));
}

TEST_F(MotionNodelet, DoesNotStartWithAWrongParameter) {
  DiagnosticsListener diagnostics(bench().node, "wrong/motion");
  EXPECT_TRUE(diagnostics.waitForMessage(diagnostic_msgs::DiagnosticStatus::ERROR, "tracking/model"))
      << diagnostics.last();
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "motion_nodelet_test");
}
