#include "ros/tracker/tracker_diagnostics.h"

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace laparoscope_servo {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;
using tracking::State;

Processed processed(State state, const std::string& reason = "") {
  Processed result;
  result.result.state = state;
  result.result.reason = reason;
  result.image = cv::Mat::zeros(4, 4, CV_8UC3);
  result.camera = geometry::PinholeCamera{1.0, 1.0, 0.0, 0.0};
  result.processing_time = 0.002;
  return result;
}

std::string value(const DiagnosticStatusWrapper& status, const std::string& key) {
  for (const auto& entry : status.values) {
    if (entry.key == key) return entry.value;
  }
  return "no such key";
}

TEST(TrackerDiagnosticsTest, LevelFollowsTheState) {
  const struct {
    State state;
    int level;
  } cases[] = {{State::kIdle, DiagnosticStatus::OK},
               {State::kTracking, DiagnosticStatus::OK},
               {State::kSearching, DiagnosticStatus::WARN},
               {State::kLost, DiagnosticStatus::ERROR}};
  for (const auto& test : cases) {
    TrackerDiagnostics diagnostics{tracking::TrackerConfig()};
    diagnostics.processed(1.0, processed(test.state, "because"), false);
    DiagnosticStatusWrapper status;
    diagnostics.fill(1.5, status);
    EXPECT_EQ(status.level, test.level);
    EXPECT_NE(status.message.find(tracking::stateName(test.state)), std::string::npos) << status.message;
    EXPECT_NE(status.message.find("because"), std::string::npos) << status.message;
    EXPECT_EQ(value(status, "reason"), "because");
  }
}

TEST(TrackerDiagnosticsTest, WarnsWithoutImages) {
  TrackerDiagnostics diagnostics{tracking::TrackerConfig()};
  DiagnosticStatusWrapper status;
  diagnostics.fill(1.0, status);
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  diagnostics.processed(2.0, processed(State::kTracking), false);
  DiagnosticStatusWrapper silent;
  diagnostics.fill(5.0, silent);
  EXPECT_EQ(silent.level, DiagnosticStatus::WARN);
  EXPECT_NE(silent.message.find("no image"), std::string::npos);
}

TEST(TrackerDiagnosticsTest, WarnsWithoutIntrinsicsAndSaysWhy) {
  TrackerDiagnostics diagnostics{tracking::TrackerConfig()};
  Processed blind = processed(State::kTracking);
  blind.camera.reset();
  blind.camera_error = "focal lengths are zero";
  diagnostics.processed(1.0, blind, false);
  DiagnosticStatusWrapper status;
  diagnostics.fill(1.5, status);
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_NE(status.message.find("focal lengths are zero"), std::string::npos) << status.message;
}

TEST(TrackerDiagnosticsTest, ReportsARefusedImageUntilAGoodOneComes) {
  TrackerDiagnostics diagnostics{tracking::TrackerConfig()};
  diagnostics.refused(1.0, "image is truncated");
  DiagnosticStatusWrapper bad;
  diagnostics.fill(1.5, bad);
  EXPECT_EQ(bad.level, DiagnosticStatus::ERROR);
  EXPECT_NE(bad.message.find("image is truncated"), std::string::npos);
  diagnostics.processed(2.0, processed(State::kTracking), false);
  DiagnosticStatusWrapper good;
  diagnostics.fill(2.5, good);
  EXPECT_EQ(good.level, DiagnosticStatus::OK);
  EXPECT_EQ(value(good, "images refused"), "1");
  EXPECT_EQ(value(good, "last refusal"), "image is truncated");
}

TEST(TrackerDiagnosticsTest, CountsSinceTheLastCall) {
  TrackerDiagnostics diagnostics{tracking::TrackerConfig()};
  DiagnosticStatusWrapper first;
  diagnostics.fill(10.0, first);
  for (int k = 0; k < 25; ++k) diagnostics.processed(10.0 + 0.04 * k, processed(State::kTracking), false);
  DiagnosticStatusWrapper second;
  diagnostics.fill(11.0, second);
  EXPECT_EQ(value(second, "rate [Hz]"), "25.00");
  EXPECT_EQ(value(second, "time per image, mean [ms]"), "2.000");
  DiagnosticStatusWrapper third;
  diagnostics.fill(12.0, third);
  EXPECT_EQ(value(third, "rate [Hz]"), "0.00");
}

TEST(TrackerDiagnosticsTest, CountsDroppedImagesByGapsOfTheStamps) {
  TrackerDiagnostics diagnostics{tracking::TrackerConfig()};
  double now = 10.0;
  const auto image = [&](double period) {
    Processed next = processed(State::kTracking);
    next.period = period;
    diagnostics.processed(now += period, next, false);
  };
  for (int k = 0; k < 50; ++k) image(0.04);
  image(0.08);  // one is missing
  for (int k = 0; k < 10; ++k) image(0.035 + 0.001 * k);
  image(0.41);  // nine
  DiagnosticStatusWrapper status;
  diagnostics.fill(now, status);
  EXPECT_EQ(value(status, "images dropped"), "10");
  EXPECT_EQ(value(status, "images dropped, last minute"), "10");
  EXPECT_EQ(value(status, "usual period [ms]"), "40.000");
  DiagnosticStatusWrapper later;
  diagnostics.fill(now + 61.0, later);
  EXPECT_EQ(value(later, "images dropped"), "10");
  EXPECT_EQ(value(later, "images dropped, last minute"), "0");
}

TEST(TrackerDiagnosticsTest, HasPercentilesOfTheLastMinute) {
  TrackerDiagnostics diagnostics{tracking::TrackerConfig()};
  for (int k = 1; k <= 100; ++k) {
    Processed next = processed(State::kTracking);
    next.processing_time = 1e-3 * k;
    diagnostics.processed(10.0 + 0.04 * k, next, false);
    diagnostics.answered(10.0 + 0.04 * k, 2e-3 * k);
  }
  DiagnosticStatusWrapper status;
  diagnostics.fill(14.0, status);
  EXPECT_EQ(value(status, "time per image, 95th percentile [ms]"), "95.000");
  EXPECT_EQ(value(status, "time per image, 99th percentile [ms]"), "99.000");
  EXPECT_EQ(value(status, "latency, stamp to result, 95th percentile [ms]"), "190.000");
  EXPECT_EQ(value(status, "latency, stamp to result, 99th percentile [ms]"), "198.000");
}

TEST(TrackerDiagnosticsTest, CountsRefusalsByCauseAndRepeats) {
  TrackerDiagnostics diagnostics{tracking::TrackerConfig()};
  diagnostics.refused(1.0, "odd", Refusal::kSize);
  diagnostics.refused(1.1, "late", Refusal::kStamp);
  diagnostics.refused(1.2, "late", Refusal::kStamp);
  diagnostics.refused(1.3, "other", Refusal::kSender);
  Processed repeated = processed(State::kSearching, "the picture repeats");
  repeated.repeats.whole = repeated.repeats.region = 3;
  diagnostics.processed(1.4, repeated, false);
  DiagnosticStatusWrapper status;
  diagnostics.fill(1.5, status);
  EXPECT_EQ(value(status, "images refused"), "4");
  EXPECT_EQ(value(status, "images refused, by cause"), "data 0, stamp 2, size 1, sender 1");
  EXPECT_EQ(value(status, "pictures repeated"), "1");
  EXPECT_NE(status.message.find("the picture repeats"), std::string::npos) << status.message;
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
}

TEST(TrackerDiagnosticsTest, WarnsOfSeveralPublishers) {
  TrackerDiagnostics diagnostics{tracking::TrackerConfig()};
  diagnostics.processed(1.0, processed(State::kTracking), false);
  diagnostics.setPublishers({1, 1, "", ""});
  DiagnosticStatusWrapper one;
  diagnostics.fill(1.5, one);
  EXPECT_EQ(one.level, DiagnosticStatus::OK);
  diagnostics.setPublishers({2, 1, "those of /other are refused", ""});
  DiagnosticStatusWrapper two;
  diagnostics.fill(1.6, two);
  EXPECT_EQ(two.level, DiagnosticStatus::WARN);
  EXPECT_NE(two.message.find("2 publishers of image: those of /other are refused"), std::string::npos) << two.message;
  EXPECT_EQ(value(two, "publishers of image"), "2");
}

TEST(TrackerDiagnosticsTest, KeepsTheReasonOfTheLastReset) {
  TrackerDiagnostics diagnostics{tracking::TrackerConfig()};
  diagnostics.processed(1.0, processed(State::kTracking), false);
  diagnostics.processed(1.1, processed(State::kIdle, "time jumped back"), false);
  diagnostics.processed(1.2, processed(State::kIdle, "no region selected"), false);
  DiagnosticStatusWrapper status;
  diagnostics.fill(1.5, status);
  EXPECT_EQ(value(status, "last reset"), "time jumped back");
}

TEST(TrackerDiagnosticsTest, TellsWhenTheColourGateStandsAsideAndWhenDistortionIsIgnored) {
  TrackerDiagnostics diagnostics{tracking::TrackerConfig()};
  Processed grey = processed(State::kTracking);
  grey.image = cv::Mat::zeros(4, 4, CV_8UC1);
  diagnostics.processed(1.0, grey, true);
  DiagnosticStatusWrapper status;
  diagnostics.fill(1.5, status);
  EXPECT_NE(value(status, "colour gate").find("no colour"), std::string::npos);
  EXPECT_NE(value(status, "lens distortion").find("not corrected"), std::string::npos);
}

TEST(TrackerDiagnosticsTest, CountsHowOftenTheRobotsMotionWasThere) {
  TrackerDiagnostics diagnostics(tracking::TrackerConfig(), true);
  Processed with = processed(State::kTracking);
  with.motion_wanted = true;
  with.result.motion_used = true;
  Processed without = processed(State::kTracking);
  without.motion_wanted = true;
  without.motion_error = "tf does not know";
  for (const Processed& each : {with, with, without, processed(State::kIdle)}) diagnostics.processed(1.0, each, false);
  DiagnosticStatusWrapper status;
  diagnostics.fill(1.5, status);
  EXPECT_EQ(value(status, "robot motion"), "given for 2 of 3 images, used for 2; last missing: tf does not know");
  DiagnosticStatusWrapper later;
  diagnostics.fill(2.5, later);
  EXPECT_EQ(value(later, "robot motion"), "given for 0 of 0 images, used for 0");
  DiagnosticStatusWrapper off;
  TrackerDiagnostics(tracking::TrackerConfig()).fill(1.0, off);
  EXPECT_EQ(value(off, "robot motion"), "not asked for");
}

TEST(TrackerDiagnosticsTest, SaysHowOftenAnExternalMaskWasUsedAndWhatItCovers) {
  TrackerDiagnostics diagnostics(tracking::TrackerConfig(), false, true);
  Processed own = processed(State::kTracking), predicted = processed(State::kTracking);
  own.external_mask = {cv::Mat::zeros(4, 4, CV_8UC1), 0.0, 0.0};
  predicted.external_mask = {cv::Mat::zeros(4, 4, CV_8UC1), 0.04, 6.0};
  predicted.mask_share = 0.25;
  for (const Processed& each : {own, processed(State::kTracking), predicted}) diagnostics.processed(1.0, each, false);
  DiagnosticStatusWrapper status;
  diagnostics.fill(1.5, status);
  EXPECT_EQ(value(status, "external mask"),
            "used for 2 of 3 images, of these 1 as predicted; the last one was 0.04 s old, grown by 6 px, and covers "
            "0.25 of the region");
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  DiagnosticStatusWrapper later;
  diagnostics.fill(2.5, later);
  EXPECT_EQ(value(later, "external mask"), "used for 0 of 0 images, of these 0 as predicted");
  DiagnosticStatusWrapper off;
  TrackerDiagnostics(tracking::TrackerConfig()).fill(1.0, off);
  EXPECT_EQ(value(off, "external mask"), "not asked for");
}

TEST(TrackerDiagnosticsTest, WarnsForAWhileOfAMaskThatWasRefused) {
  TrackerDiagnostics diagnostics(tracking::TrackerConfig(), false, true);
  diagnostics.processed(1.0, processed(State::kTracking), false);
  diagnostics.maskRefused(1.0, "encoding 'bgr8', expected mono8");
  DiagnosticStatusWrapper status;
  diagnostics.fill(1.5, status);
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_NE(status.message.find("external mask refused: encoding 'bgr8'"), std::string::npos) << status.message;
  diagnostics.processed(9.0, processed(State::kTracking), false);
  DiagnosticStatusWrapper later;
  diagnostics.fill(9.5, later);
  EXPECT_EQ(later.level, DiagnosticStatus::OK);
}

TEST(TrackerDiagnosticsTest, SaysWhoTakesTheLensOut) {
  TrackerDiagnostics diagnostics{tracking::TrackerConfig()};
  Processed rectified = processed(State::kTracking);
  image::LensParameters lens;
  lens.raw = lens.rectified = {1.0, 1.0, 0.0, 0.0};
  rectified.lens = std::make_shared<const image::Lens>(lens);
  diagnostics.processed(1.0, rectified, false);
  DiagnosticStatusWrapper status;
  diagnostics.fill(1.5, status);
  EXPECT_EQ(value(status, "lens distortion"), "corrected by the tracker");
}

TEST(TrackerDiagnosticsTest, SaysWhichViewIsRecalledAndWhyTheLastOneWasNot) {
  TrackerDiagnostics diagnostics{tracking::TrackerConfig()};
  diagnostics.processed(1.0, processed(State::kTracking), false);
  DiagnosticStatusWrapper without;
  diagnostics.fill(1.1, without);
  EXPECT_EQ(value(without, "recall"), "none");
  EXPECT_EQ(without.message, "TRACKING");
  Processed going = processed(State::kTracking);
  going.recall = "going to view 'liver'";
  diagnostics.processed(2.0, going, false);
  diagnostics.recallRefused("view 'bile duct': not stored");
  DiagnosticStatusWrapper status;
  diagnostics.fill(2.1, status);
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(status.message, "TRACKING; going to view 'liver'");
  EXPECT_EQ(value(status, "recall"), "going to view 'liver'; last request refused: view 'bile duct': not stored");
  diagnostics.recallRefused("");
  DiagnosticStatusWrapper after;
  diagnostics.fill(2.2, after);
  EXPECT_EQ(value(after, "recall"), "going to view 'liver'");
}

}  // namespace
}  // namespace laparoscope_servo
