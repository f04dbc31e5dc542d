// The nodelets Dots, Points and Edges beside the region tracker in one manager: selection, tracking, and whatever may
// go wrong with images and selections.
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <cmath>
#include <string>
#include <vector>

#include "feature_bench.h"

namespace laparoscope_servo {
namespace {

using test_support::DiagnosticsListener;
using test_support::FeatureBench;
using test_support::Inbox;
using test_support::waitFor;

class FeaturesNodelets : public testing::TestWithParam<std::string> {
 protected:
  // Connections take longer than the tests: one bench for all of them.
  static FeatureBench& bench() {
    static FeatureBench bench({"dots", "points", "edges"},
                              [](unsigned number) { return test_support::featureScene(0.0, number); });
    return bench;
  }

  void SetUp() override {
    ASSERT_TRUE(bench().ready()) << "the nodelets are not there";
    // Whatever the test before did to time and size.
    ASSERT_TRUE(bench().settle(kind()));
    for (const char* const each : {"dots", "points", "edges"}) ASSERT_TRUE(bench().reset(each));
  }

  static const std::string& kind() { return GetParam(); }
  static std::string selection(const std::string& of = kind()) {
    return of == "dots"     ? test_support::kDotsSelection
           : of == "points" ? test_support::kPointsSelection
                            : test_support::kEdgesSelection;
  }
  void select() {
    const SelectFeatures::Response answer = bench().select(kind(), selection());
    ASSERT_TRUE(answer.success) << answer.message;
  }
  TrackedFeaturesConstPtr track(double shift = 0.0) {
    return bench().track(kind(), test_support::featureScene(shift, bench().nextNumber()));
  }
};

TEST_P(FeaturesNodelets, AnswersEveryImageAlsoWhileIdle) {
  const ros::Time stamp = FeatureBench::nextStamp();
  const TrackedFeaturesConstPtr told = bench().track(kind(), bench().picture(), stamp);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->header.frame_id, "optical_of_the_test");
  EXPECT_EQ(told->state, TrackedFeatures::IDLE);
  EXPECT_EQ(told->reason, "reset");
  EXPECT_TRUE(told->features.empty());
}

TEST_P(FeaturesNodelets, SelectsInTheNextImageAndTracks) {
  const SelectFeatures::Response answer = bench().select(kind(), selection());
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.message, "selected: 2");
  const TrackedFeaturesConstPtr told = track(2.0);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->state, TrackedFeatures::TRACKING) << told->reason;
  ASSERT_EQ(told->features.size(), 2u);
  if (kind() == "dots") {
    EXPECT_EQ(told->features[0].id, "large");
    EXPECT_EQ(told->features[0].kind, TrackedFeature::POINT);
    EXPECT_NEAR(told->features[0].parameters.at(0), 92.0, 0.2);
    EXPECT_NEAR(told->features[0].parameters.at(1), 120.0, 0.2);
  } else if (kind() == "points") {
    EXPECT_EQ(told->features[1].id, "beside");
    EXPECT_EQ(told->features[1].kind, TrackedFeature::POINT);
    EXPECT_NEAR(told->features[1].parameters.at(0), 174.0, 0.2);
    EXPECT_NEAR(told->features[1].parameters.at(1), 60.0, 0.2);
    EXPECT_EQ(told->features[1].outline.size(), 10u);
  } else {
    EXPECT_EQ(told->features[0].id, "border");
    EXPECT_EQ(told->features[0].kind, TrackedFeature::LINE);
    EXPECT_NEAR(std::abs(told->features[0].parameters.at(0)), 222.0, 0.2);
    EXPECT_EQ(told->features[1].kind, TrackedFeature::ELLIPSE);
    EXPECT_EQ(told->features[1].covariance.size(), 25u);
  }
}

TEST_P(FeaturesNodelets, SaysWhatIsWrongWithASelectionAndGoesOn) {
  select();
  const bool of_points = kind() != "edges";
  const std::string other = selection(of_points ? "edges" : "dots");
  const std::vector<std::pair<std::string, std::string>> bad = {
      {of_points ? "[{id: off, point: [9999, 50]}]" : "[{id: off, line: [[9000, 50], [9100, 50]]}]", ""},
      {of_points ? "[{id: a, point: [90, 50]}, {id: b, point: [90.5, 50]}]"  // one dot, or one place, twice
                 : "[{id: short, line: [[50, 50], [50, 50]]}]",
       of_points ? "no other point" : "short: line from (50, 50) to (50, 50)"},
      {other, "expected " + std::string(of_points ? "point" : "line, ellipse or spline") + " of this tracker"},
      {"[{id: nan, point: [.nan, 50]}]", of_points ? "point = [nan, 50]" : "of this tracker"},
      {"[{id: many, corners: {count: 0}}]", kind() == "points" ? "number of corners = 0" : "of"},
      {"[{id: flat, corners: {region: [140, 150, 40, 40]}}]", kind() == "points" ? "flat: 0 corners" : "of"},
      {"[{id: gone, point: [90, 50], stored: /nowhere/liver.png}]", "stored = /nowhere/liver.png"},
      {"[{id: x, lien: [[1, 2], [3, 4]]}]", "key lien"},
      {"[{id: x", "selection: "},
      {"", "no list of features"}};
  for (const auto& [text, part] : bad) {
    const SelectFeatures::Response answer = bench().select(kind(), text);
    EXPECT_FALSE(answer.success) << text;
    EXPECT_NE(answer.message, "") << text;
    EXPECT_NE(answer.message.find(part), std::string::npos) << text << ": " << answer.message;
  }
  const TrackedFeaturesConstPtr told = track();
  ASSERT_TRUE(told);
  EXPECT_EQ(told->state, TrackedFeatures::TRACKING) << told->reason;
}

TEST_P(FeaturesNodelets, SaysThatNoImageComes) {
  const SelectFeatures::Response answer = bench().ask(kind(), selection()).get();
  EXPECT_FALSE(answer.success);
  EXPECT_NE(answer.message.find("no image came on /scope/image within 1 s"), std::string::npos) << answer.message;
}

// It may be the first one of another camera: who moves by the features must not go on by the image before it.
TEST_P(FeaturesNodelets, SaysOfTheFirstImageOfAnotherKindThatNothingIsSeenAndGoesOn) {
  DiagnosticsListener diagnostics(bench().node(), "scope/" + kind());
  select();
  const cv::Mat small(120, 160, CV_8UC1, cv::Scalar(90)), colour(240, 320, CV_8UC3, cv::Scalar::all(90));
  for (const cv::Mat& other : {small, colour}) {
    const TrackedFeaturesConstPtr not_seen = bench().track(kind(), other);
    ASSERT_TRUE(not_seen);
    EXPECT_EQ(not_seen->state, TrackedFeatures::SEARCHING);
    EXPECT_EQ(not_seen->width, static_cast<std::uint32_t>(other.cols));
    EXPECT_FALSE(not_seen->selection_stamp.isZero());
    for (const TrackedFeature& feature : not_seen->features) {
      EXPECT_EQ(feature.state, TrackedFeatures::SEARCHING);
      EXPECT_NE(feature.reason.find("another camera is believed"), std::string::npos) << feature.reason;
    }
    EXPECT_TRUE(diagnostics.waitForMessage(diagnostic_msgs::DiagnosticStatus::ERROR, "another camera is believed"))
        << diagnostics.last();
    const TrackedFeaturesConstPtr told = track();
    ASSERT_TRUE(told);
    EXPECT_EQ(told->state, TrackedFeatures::TRACKING) << told->reason;
  }
}

TEST_P(FeaturesNodelets, EndsWithAnotherSizeAndWithAnotherColour) {
  const cv::Mat small(120, 160, CV_8UC1, cv::Scalar(90)), colour(240, 320, CV_8UC3, cv::Scalar::all(90));
  for (const cv::Mat& other : {small, colour}) {
    ASSERT_TRUE(bench().settle(kind()));
    select();
    TrackedFeaturesConstPtr told;
    ASSERT_TRUE(waitFor([&] {
      told = bench().track(kind(), other, FeatureBench::nextStamp(), 0.3);
      return told && told->state == TrackedFeatures::IDLE;
    }));
    EXPECT_NE(told->reason.find("another size or type"), std::string::npos) << told->reason;
  }
}

TEST_P(FeaturesNodelets, ForgetsWhenTimeJumpsBack) {
  select();
  ros::Time stamp = FeatureBench::nextStamp() - ros::Duration(500.0);
  TrackedFeaturesConstPtr told;
  ASSERT_TRUE(waitFor([&] {
    stamp += ros::Duration(0.04);
    return (told = bench().track(kind(), bench().picture(), stamp, 0.3)) != nullptr;
  }));
  EXPECT_EQ(told->state, TrackedFeatures::IDLE);
  EXPECT_EQ(told->reason, "time jumped back");
}

TEST_P(FeaturesNodelets, BelievesNoFrozenFeed) {
  select();
  const cv::Mat frozen = bench().picture();
  TrackedFeaturesConstPtr told;
  for (int k = 0; k < 4; ++k) ASSERT_TRUE(told = bench().track(kind(), frozen));
  EXPECT_EQ(told->state, TrackedFeatures::SEARCHING);
  EXPECT_NE(told->reason.find("the picture repeats"), std::string::npos) << told->reason;
  ASSERT_TRUE(bench().trackUntil(kind(), TrackedFeatures::TRACKING));
}

TEST_P(FeaturesNodelets, DrawsWhileSomebodyListens) {
  select();
  Inbox<sensor_msgs::Image> overlays(bench().node(), kind() + "/overlay");
  sensor_msgs::ImageConstPtr overlay;
  ASSERT_TRUE(waitFor([&] {
    const TrackedFeaturesConstPtr told = track();
    return told && waitFor([&] { return (overlay = overlays.at(told->header.stamp)) != nullptr; }, 0.3);
  }));
  EXPECT_EQ(overlay->encoding, "bgr8");
  EXPECT_EQ(overlay->width, 320u);
}

TEST_P(FeaturesNodelets, TellsEachFeatureInTheDiagnostics) {
  DiagnosticsListener diagnostics(bench().node(), "scope/" + kind());
  select();
  const std::string key = kind() == "dots" ? "feature large" : kind() == "points" ? "feature middle" : "feature border";
  EXPECT_TRUE(waitFor([&] {
    track();
    return diagnostics.value(key).find("TRACKING") != std::string::npos;
  })) << diagnostics.last();
}

// One picture, two kinds, and what is done to one does not concern the other.
TEST_P(FeaturesNodelets, LeavesTheOtherKindAlone) {
  const std::string other = kind() == "dots" ? "edges" : "dots";
  ASSERT_TRUE(bench().select(other, selection(other)).success);
  select();
  ASSERT_TRUE(bench().reset(kind()));
  EXPECT_EQ(track()->state, TrackedFeatures::IDLE);
  const TrackedFeaturesConstPtr told = bench().track(other, bench().picture());
  ASSERT_TRUE(told);
  EXPECT_EQ(told->state, TrackedFeatures::TRACKING) << told->reason;
}

TEST_P(FeaturesNodelets, StaysInactiveWithWrongParametersAndSaysWhy) {
  DiagnosticsListener diagnostics(bench().node(), "wrong/" + kind());
  EXPECT_TRUE(diagnostics.waitForMessage(diagnostic_msgs::DiagnosticStatus::ERROR, "tracking/rnge"))
      << diagnostics.last();
  EXPECT_NE(diagnostics.last().message.find(kind() == "points" ? "tracking/min_share" : "tracking/min_contrast"),
            std::string::npos)
      << diagnostics.last();
}

// With the file of the parameter, whole path, in the first image.
TEST_P(FeaturesNodelets, SelectsTheFileInTheFirstImage) {
  ros::NodeHandle node("from_file");
  ros::Publisher images = node.advertise<sensor_msgs::Image>("image", 1);
  Inbox<TrackedFeatures> inbox(node, kind() + "/features");
  ASSERT_TRUE(waitFor([&] { return images.getNumSubscribers() >= 1 && inbox.connected(); }));
  TrackedFeaturesConstPtr told;
  ASSERT_TRUE(waitFor([&] {
    const sensor_msgs::ImagePtr message = test_support::imageAt(bench().picture(), FeatureBench::nextStamp().toSec());
    images.publish(message);
    return waitFor([&] { return (told = inbox.at(message->header.stamp)) != nullptr; }, 0.5);
  }));
  EXPECT_EQ(told->state, TrackedFeatures::TRACKING) << told->reason;
}

INSTANTIATE_TEST_SUITE_P(All, FeaturesNodelets, testing::Values("dots", "points", "edges"));

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "features_nodelets_test");
}
