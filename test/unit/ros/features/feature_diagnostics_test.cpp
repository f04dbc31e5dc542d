#include "ros/features/feature_diagnostics.h"

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <gtest/gtest.h>

namespace laparoscope_servo {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using features::State;

features::TrackedFeatures in(State state, const std::string& reason) {
  features::TrackedFeatures tracked;
  tracked.features.resize(1);
  tracked.features[0].id = "shaft";
  tracked.features[0].kind = features::FeatureKind::kLine;
  tracked.features[0].state = state;
  tracked.features[0].reason = reason;
  tracked.features[0].share = 0.75;
  tracked.features[0].expected_error = 0.125;
  features::summarise(tracked, "");
  return tracked;
}

std::string valueOf(const DiagnosticStatus& status, const std::string& key) {
  for (const auto& value : status.values) {
    if (value.key == key) return value.value;
  }
  return "no key " + key;
}

class FeatureDiagnostics : public testing::Test {
 protected:
  DiagnosticStatus fill(const features::TrackedFeatures& tracked, const std::string& error = "", double now = 1.0) {
    diagnostic_updater::DiagnosticStatusWrapper status;
    fillFeatureDiagnostics(now, tracked, error, feed_, status);
    return status;
  }
  FeedStatistics feed_;
};

TEST_F(FeatureDiagnostics, WarnsUntilAnImageComes) {
  const DiagnosticStatus status = fill({});
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_EQ(status.message, "no image has come yet");
}

TEST_F(FeatureDiagnostics, HasALevelForEachState) {
  feed_.processed(0.9, 0.04, 0.002, false);
  EXPECT_EQ(fill(in(State::kTracking, "")).level, DiagnosticStatus::OK);
  EXPECT_EQ(fill(in(State::kTracking, "")).message, "TRACKING");
  EXPECT_EQ(fill(in(State::kSearching, "covered")).level, DiagnosticStatus::WARN);
  EXPECT_EQ(fill(in(State::kSearching, "covered")).message, "SEARCHING: shaft: covered");
  EXPECT_EQ(fill(in(State::kLost, "covered")).level, DiagnosticStatus::ERROR);
}

TEST_F(FeatureDiagnostics, TellsOfTheImagesAndOfEachFeature) {
  feed_.processed(0.8, 0.04, 0.002, false);
  feed_.processed(0.9, 0.04, 0.004, true);
  feed_.setPublishers({2, 1, "", ""});
  const DiagnosticStatus status = fill(in(State::kTracking, ""));
  EXPECT_EQ(valueOf(status, "feature shaft"), "line, TRACKING, share 0.75, expected error 0.125 px");
  EXPECT_EQ(valueOf(status, "images processed"), "2");
  EXPECT_EQ(valueOf(status, "pictures repeated"), "1");
  EXPECT_EQ(valueOf(status, "time per image, mean [ms]"), "3.000");
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_NE(status.message.find("2 publishers of image"), std::string::npos);
}

TEST_F(FeatureDiagnostics, SaysWhatIsRefused) {
  feed_.processed(0.9, 0.04, 0.002, false);
  const DiagnosticStatus selection = fill({}, "shaft: no such edge");
  EXPECT_EQ(selection.level, DiagnosticStatus::ERROR);
  EXPECT_NE(selection.message.find("nothing was selected: shaft: no such edge"), std::string::npos);
  feed_.refused(1.0, "no stamp", Refusal::kStamp);
  const DiagnosticStatus image = fill(in(State::kTracking, ""));
  EXPECT_EQ(image.message, "image refused: no stamp");
  EXPECT_EQ(valueOf(image, "images refused, by cause"), "data 0, stamp 1, size 0, sender 0");
  EXPECT_EQ(fill(in(State::kTracking, ""), "", 9.0).message, "no image for more than 2 s; before: TRACKING");
}

}  // namespace
}  // namespace laparoscope_servo
