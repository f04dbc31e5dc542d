// The nodelet Instrument: finds without a selection, publishes features and mask, and goes on after bad input.
#include <gtest/gtest.h>
#include <laparoscope_servo/SelectFeatures.h>
#include <laparoscope_servo/TrackedFeatures.h>
#include <ros/ros.h>

#include "node/tracker/camera_bench.h"
#include "support/feature_scene.h"
#include "support/instrument_scene.h"

namespace laparoscope_servo {
namespace {

using test_support::DiagnosticsListener;
using test_support::imageAt;
using test_support::Inbox;
using test_support::instrumentScene;
using test_support::waitFor;

class InstrumentNodelet : public testing::Test {
 protected:
  struct Bench {
    ros::NodeHandle node{"scope"};
    ros::Publisher images = node.advertise<sensor_msgs::Image>("image", 1);
    Inbox<TrackedFeatures> features{node, "instrument/features"};
    Inbox<sensor_msgs::Image> masks{node, "instrument/mask"};
    unsigned image = 0;
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
    ASSERT_TRUE(ros::service::call("/scope/instrument/reset", call) && call.response.success);
  }

  // Null when the image is refused.
  TrackedFeaturesConstPtr send(const cv::Mat& image, double patience = 20.0) {
    const sensor_msgs::ImagePtr message = imageAt(image, bench().time += 0.04);
    bench().images.publish(message);
    waitFor([&] { return bench().features.at(message->header.stamp) != nullptr; }, patience);
    return bench().features.at(message->header.stamp);
  }
  TrackedFeaturesConstPtr track() { return send(instrumentScene(0.0, ++bench().image), 0.5); }
  TrackedFeaturesConstPtr trackUntil(std::uint8_t state) {
    TrackedFeaturesConstPtr told;
    waitFor([&] { return (told = track()) != nullptr && told->state == state; });
    return told && told->state == state ? told : nullptr;
  }
};

TEST_F(InstrumentNodelet, FindsTheInstrumentAndSaysWhatItCovers) {
  const TrackedFeaturesConstPtr told = trackUntil(TrackedFeatures::TRACKING);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->header.frame_id, "optical_of_the_test");
  ASSERT_GE(told->features.size(), 3u);
  EXPECT_EQ(told->features.back().kind, TrackedFeature::POINT);
  const sensor_msgs::ImageConstPtr mask = bench().masks.waitFor(told->header.stamp);
  ASSERT_TRUE(mask);
  EXPECT_EQ(mask->encoding, "mono8");
  ASSERT_EQ(mask->data.size(), 320u * 240u);
  EXPECT_EQ(mask->data[135 * 320 + 165], 255);
  EXPECT_EQ(mask->data[20 * 320 + 300], 0);
}

TEST_F(InstrumentNodelet, RefusesImagesWithoutColourAndGoesOn) {
  DiagnosticsListener diagnostics(bench().node, "scope/instrument");
  ASSERT_TRUE(trackUntil(TrackedFeatures::TRACKING));
  const cv::Mat grey(240, 320, CV_8UC1, cv::Scalar(90));
  for (int k = 0; k < 4; ++k) EXPECT_FALSE(send(grey, 0.2));  // also when a camera without colour is believed
  EXPECT_TRUE(diagnostics.waitForMessage(diagnostic_msgs::DiagnosticStatus::ERROR, "image refused"))
      << diagnostics.last();
  EXPECT_TRUE(trackUntil(TrackedFeatures::TRACKING));
}

TEST_F(InstrumentNodelet, RefusesASelection) {
  SelectFeatures call;
  call.request.selection = test_support::kDotsSelection;
  auto answer =
      std::async(std::launch::async, [&call] { return ros::service::call("/scope/instrument/select_features", call); });
  while (answer.wait_for(std::chrono::milliseconds(5)) != std::future_status::ready) track();
  ASSERT_TRUE(answer.get());
  EXPECT_FALSE(call.response.success);
  EXPECT_NE(call.response.message.find("found without a selection"), std::string::npos) << call.response.message;
}

// As another one: what was is forgotten.
TEST_F(InstrumentNodelet, FindsItAnewWhenTimeJumpsBack) {
  const TrackedFeaturesConstPtr before = trackUntil(TrackedFeatures::TRACKING);
  ASSERT_TRUE(before);
  bench().time -= 500.0;
  TrackedFeaturesConstPtr told;
  ASSERT_TRUE(waitFor([&] {
    told = track();
    return told && told->state == TrackedFeatures::TRACKING && told->header.stamp < before->header.stamp;
  }));
  EXPECT_NE(told->features.back().id, before->features.back().id);
}

TEST_F(InstrumentNodelet, DoesNotStartWithASelection) {
  DiagnosticsListener diagnostics(bench().node, "wrong/instrument");
  EXPECT_TRUE(diagnostics.waitForMessage(diagnostic_msgs::DiagnosticStatus::ERROR, "/nowhere/features.yaml"))
      << diagnostics.last();
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "instrument_nodelet_test");
}
