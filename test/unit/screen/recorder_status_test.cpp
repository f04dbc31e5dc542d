#include "screen/recorder_status.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::screen {
namespace {

diagnostic_msgs::DiagnosticArray diagnostics(const std::string& name) {
  diagnostic_msgs::DiagnosticArray message;
  message.status.resize(2);
  message.status[0].name = "tracker: tracking";
  diagnostic_msgs::DiagnosticStatus& status = message.status[1];
  status.name = name;
  status.level = diagnostic_msgs::DiagnosticStatus::ERROR;
  status.message = "nothing is recorded: the disk is full";
  for (const auto& [key, value] : {std::pair{"file", "/data/a/case_000.bag"},
                                   {"written [MB]", "12.5"},
                                   {"free on the disk [MB]", "3"},
                                   {"files", "1"}}) {
    diagnostic_msgs::KeyValue entry;
    entry.key = key;
    entry.value = value;
    status.values.push_back(entry);
  }
  return message;
}

TEST(RecorderStatus, IsReadFromDiagnostics) {
  const std::optional<RecorderFacts> recorder = recorderIn(diagnostics("recorder: recording"), "/");
  ASSERT_TRUE(recorder);
  EXPECT_EQ(recorder->level, diagnostic_msgs::DiagnosticStatus::ERROR);
  EXPECT_EQ(recorder->message, "nothing is recorded: the disk is full");
  EXPECT_EQ(recorder->file, "case_000.bag");
  EXPECT_EQ(recorder->written, "12.5");
  EXPECT_EQ(recorder->free, "3");
}

TEST(RecorderStatus, EachCartHasItsOwn) {
  EXPECT_FALSE(recorderIn(diagnostics("left/recorder: recording"), "/"));
  EXPECT_FALSE(recorderIn(diagnostics("recorder: recording"), "/left"));
  EXPECT_TRUE(recorderIn(diagnostics("left/recorder: recording"), "/left"));
  EXPECT_FALSE(recorderIn(diagnostics("left/recorder: recording"), "/left/inner"));
  EXPECT_FALSE(recorderIn({}, "/"));
}

TEST(RecorderStatus, OneWithoutAFileHasNone) {
  diagnostic_msgs::DiagnosticArray message = diagnostics("recorder: recording");
  message.status[1].values.clear();
  EXPECT_EQ(recorderIn(message, "/")->file, "");
}

}  // namespace
}  // namespace laparoscope_servo::screen
