// The nodelet Instrument: finds without a selection, publishes features and mask, and goes on after bad input.
#include <gtest/gtest.h>
#include <ros/ros.h>

#include "feature_bench.h"
#include "support/instrument_scene.h"

namespace laparoscope_servo {
namespace {

using test_support::DiagnosticsListener;
using test_support::FeatureBench;
using test_support::Inbox;
using test_support::waitFor;

const char* const kKind = "instrument";

class InstrumentNodelet : public testing::Test {
 protected:
  struct Bench : FeatureBench {
    Bench() : FeatureBench({kKind}, [](unsigned number) { return test_support::instrumentScene(0.0, number); }) {}
    Inbox<sensor_msgs::Image> masks{node(), "instrument/mask"};
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

  static TrackedFeaturesConstPtr trackUntil(std::uint8_t state) { return bench().trackUntil(kKind, state); }
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
  DiagnosticsListener diagnostics(bench().node(), "scope/instrument");
  ASSERT_TRUE(trackUntil(TrackedFeatures::TRACKING));
  const cv::Mat grey(240, 320, CV_8UC1, cv::Scalar(90));
  for (int k = 0; k < 4; ++k) {  // also when a camera without colour is believed
    const TrackedFeaturesConstPtr told = bench().track(kKind, grey, FeatureBench::nextStamp(), 0.2);
    EXPECT_TRUE(!told || told->state != TrackedFeatures::TRACKING);
  }
  EXPECT_TRUE(diagnostics.waitForMessage(diagnostic_msgs::DiagnosticStatus::ERROR, "image refused"))
      << diagnostics.last();
  EXPECT_TRUE(trackUntil(TrackedFeatures::TRACKING));
}

TEST_F(InstrumentNodelet, RefusesASelection) {
  const SelectFeatures::Response answer = bench().select(kKind, test_support::kDotsSelection);
  EXPECT_FALSE(answer.success);
  EXPECT_NE(answer.message.find("found without a selection"), std::string::npos) << answer.message;
}

// As another one: what was is forgotten.
TEST_F(InstrumentNodelet, FindsItAnewWhenTimeJumpsBack) {
  const TrackedFeaturesConstPtr before = trackUntil(TrackedFeatures::TRACKING);
  ASSERT_TRUE(before);
  ros::Time stamp = FeatureBench::nextStamp() - ros::Duration(500.0);
  TrackedFeaturesConstPtr told;
  ASSERT_TRUE(waitFor([&] {
    stamp += ros::Duration(0.04);
    told = bench().track(kKind, bench().picture(), stamp, 0.5);
    return told && told->state == TrackedFeatures::TRACKING && told->header.stamp < before->header.stamp;
  }));
  EXPECT_NE(told->features.back().id, before->features.back().id);
}

TEST_F(InstrumentNodelet, DoesNotStartWithASelection) {
  DiagnosticsListener diagnostics(bench().node(), "wrong/instrument");
  EXPECT_TRUE(diagnostics.waitForMessage(diagnostic_msgs::DiagnosticStatus::ERROR, "/nowhere/features.yaml"))
      << diagnostics.last();
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "instrument_nodelet_test");
}
