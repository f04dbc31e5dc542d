#include "screen/playback_bar.h"

#include <gtest/gtest.h>

#include <QtTest>
#include <limits>

namespace laparoscope_servo::screen {
namespace {

TEST(PlaybackBar, IsThereOnlyWithARecordingAndSaysWhatItDoes) {
  std::vector<std::string> commands;
  QWidget window;
  PlaybackBar bar([&](const std::string& command, double) { commands.push_back(command); }, &window);
  PlaybackFacts facts;
  bar.show(facts);
  EXPECT_FALSE(bar.isVisibleTo(&window));
  facts.connected = true;
  facts.state = "HOLDING";
  bar.show(facts);
  EXPECT_TRUE(bar.isVisibleTo(&window));
  auto* words = bar.findChild<QLabel*>("playback");
  EXPECT_EQ(words->text(), "HOLDS: draw a region");
  facts.state = "PLAYING";
  facts.position = 2.0;
  facts.duration = 8.0;
  bar.show(facts);
  EXPECT_EQ(words->text(), "PLAYING  2.0 s of 8.0");
  EXPECT_EQ(bar.findChild<QSlider*>("place")->value(), 250);
  QTest::mouseClick(bar.findChild<QPushButton*>("play"), Qt::LeftButton);
  QTest::mouseClick(bar.findChild<QPushButton*>("step"), Qt::LeftButton);
  facts.state = "ENDED";
  facts.position = std::numeric_limits<double>::quiet_NaN();
  bar.show(facts);
  QTest::mouseClick(bar.findChild<QPushButton*>("again"), Qt::LeftButton);
  EXPECT_EQ(commands, (std::vector<std::string>{"PAUSE", "STEP", "AGAIN"}));
  QTest::mouseClick(bar.findChild<QPushButton*>("play"), Qt::LeftButton);
  EXPECT_EQ(commands.back(), "AGAIN") << "there is nothing to go on with";
}

}  // namespace
}  // namespace laparoscope_servo::screen
