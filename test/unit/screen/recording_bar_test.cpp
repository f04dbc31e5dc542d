#include "screen/recording_bar.h"

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <gtest/gtest.h>

namespace laparoscope_servo::screen {
namespace {

using diagnostic_msgs::DiagnosticStatus;

RecorderFacts recorder(int level, const std::string& message) {
  return {100.0, level, message, "case_000.bag", "12.5", "3000"};
}

TEST(RecordingBar, SaysWhetherACaseIsRecorded) {
  const BandText good = recordingText(recorder(DiagnosticStatus::OK, "recording"), 101.0);
  EXPECT_EQ(good.word, "RECORDING");
  EXPECT_EQ(good.sentence, "case_000.bag, 12.5 MB; 3000 MB free");
  EXPECT_EQ(good.level, Level::kGood);
  const BandText gaps = recordingText(recorder(DiagnosticStatus::WARN, "something was dropped"), 101.0);
  EXPECT_EQ(gaps.word, "RECORDING WITH GAPS");
  EXPECT_EQ(gaps.sentence.find("something was dropped"), 0u);
  EXPECT_EQ(gaps.level, Level::kWaiting);
  const BandText full = recordingText(recorder(DiagnosticStatus::ERROR, "nothing is recorded: 3 MB are free"), 101.0);
  EXPECT_EQ(full.word, "NOT RECORDING");
  EXPECT_EQ(full.sentence, "nothing is recorded: 3 MB are free");
  EXPECT_EQ(full.level, Level::kBad);
}

TEST(RecordingBar, ARecorderThatIsSilentRecordsNothing) {
  const RecorderFacts ok = recorder(DiagnosticStatus::OK, "recording");
  EXPECT_EQ(recordingText(ok, 110.0).word, "NOT RECORDING");
  EXPECT_EQ(recordingText(ok, 110.0).level, Level::kWaiting) << "somebody may have ended it";
  EXPECT_EQ(recordingText(ok, 200.0).word, "") << "and after a minute it is no news";
  EXPECT_EQ(recordingText({}, 110.0).word, "") << "there was none";
}

TEST(RecordingBar, TakesRoomOnlyWithARecorder) {
  QWidget window;
  RecordingBar bar(&window);
  bar.show(recordingText({}, 1.0));
  EXPECT_FALSE(bar.isVisibleTo(&window));
  BandText text = recordingText(recorder(DiagnosticStatus::ERROR, std::string(500, 'x') + "<b>"), 101.0);
  bar.show(text);
  EXPECT_TRUE(bar.isVisibleTo(&window));
  EXPECT_TRUE(bar.toolTip().endsWith("&lt;b&gt;")) << "no markup";
  EXPECT_EQ(bar.minimumHeight(), bar.maximumHeight());
  bar.resize(300, bar.minimumHeight());
  bar.grab();
  bar.show({});
  EXPECT_FALSE(bar.isVisibleTo(&window));
}

}  // namespace
}  // namespace laparoscope_servo::screen
