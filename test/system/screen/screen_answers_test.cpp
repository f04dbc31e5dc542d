// Answers of services that come late, when something else was asked for meanwhile: the screen's link, without its
// window, and nodes whose services wait; and nodes that end.
#include <gtest/gtest.h>
#include <ros/ros.h>

#include "ros/common/clocks.h"
#include "screen/band_text.h"
#include "screen/ros_link.h"
#include "support/ros_tests.h"
#include "system/aesop/child_process.h"
#include "system/screen/fake_nodes.h"
#include "system/screen/image_feed.h"

namespace laparoscope_servo {
namespace {

using screen::Outcome;

bool waitFor(const std::function<bool()>& condition) {
  const double until = steadyNow() + 30.0;
  while (!condition()) {
    if (steadyNow() > until || !ros::ok()) return false;
    ros::WallDuration(0.005).sleep();
  }
  return true;
}

class ScreenAnswers : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(waitFor([this] { return nodes_.connected() && link_.facts().tracker.connected; }));
  }
  bool isFrozen() const { return link_.facts().frozen.has_value(); }
  bool isAnswered(const std::string& what, Outcome outcome = Outcome::kDone) {
    return waitFor([&] { return link_.facts().answer.what == what && link_.facts().answer.outcome == outcome; });
  }
  // Asks for a frozen picture, whose answer waits.
  void askToFreeze() {
    nodes_.close("freeze");
    link_.tracker().freeze();
    ASSERT_TRUE(waitFor([this] { return nodes_.freezes == 1; }));
  }
  // Lets the answer come. Nothing tells that the screen has dealt with one that it drops: it has had the time for other
  // questions meanwhile.
  void letTheAnswerCome() {
    nodes_.open("freeze");
    ASSERT_TRUE(waitFor([this] { return nodes_.freezes_answered == 1; }));
    for (int x = 0; x < 5; ++x) {
      const QRect region(x, 0, 200, 200);
      link_.tracker().checkRegion(region);
      ASSERT_TRUE(waitFor([&] { return link_.facts().verdict && link_.facts().verdict->region == region; }));
    }
  }

  test_support::FakeNodes nodes_;
  screen::RosLink link_{[] {}};
};

TEST_F(ScreenAnswers, AFrozenPictureThatComesAfterLiveIsNotShown) {
  askToFreeze();
  link_.tracker().thaw();
  letTheAnswerCome();
  EXPECT_FALSE(isFrozen());
}

TEST_F(ScreenAnswers, APictureThatIsFrozenAnewIsWaitedFor) {
  askToFreeze();
  link_.tracker().thaw();
  link_.tracker().freeze();
  nodes_.admit("freeze", 1);
  ASSERT_TRUE(waitFor([this] { return nodes_.freezes == 2; })) << "sent when the one before was answered";
  EXPECT_FALSE(isFrozen()) << "by the one before";
  nodes_.open("freeze");
  EXPECT_TRUE(waitFor([this] { return isFrozen(); }));
}

TEST_F(ScreenAnswers, AFrozenPictureThatComesAfterStopIsNotShown) {
  askToFreeze();
  link_.stop();
  ASSERT_TRUE(isAnswered("STOP"));
  letTheAnswerCome();
  EXPECT_FALSE(isFrozen());
}

TEST_F(ScreenAnswers, AFrozenPictureThatComesAfterARegionWasTakenIsNotShown) {
  askToFreeze();
  link_.tracker().selectRegion(QRect(10, 20, 200, 200));
  ASSERT_TRUE(isAnswered("Region"));
  letTheAnswerCome();
  EXPECT_FALSE(isFrozen());
}

TEST_F(ScreenAnswers, ARegionThatIsTakenLateEndsNoPictureThatWasFrozenMeanwhile) {
  nodes_.close("region");
  link_.tracker().selectRegion(QRect(10, 20, 200, 200));
  ASSERT_TRUE(waitFor([this] { return nodes_.regions().size() == 1; }));
  link_.tracker().freeze();
  ASSERT_TRUE(waitFor([this] { return isFrozen(); }));
  nodes_.open("region");
  ASSERT_TRUE(isAnswered("Region"));
  EXPECT_TRUE(isFrozen());
}

TEST_F(ScreenAnswers, ARegionThatIsTakenLateIsNotTakenForTheOneDrawnMeanwhile) {
  nodes_.close("region");
  link_.tracker().selectRegion(QRect(10, 20, 200, 200));
  ASSERT_TRUE(waitFor([this] { return nodes_.regions().size() == 1; }));
  link_.tracker().selectRegion(QRect(30, 40, 200, 200));
  link_.tracker().selectRegion(QRect(50, 60, 200, 200));
  nodes_.admit("region", 1);
  ASSERT_TRUE(waitFor([this] { return nodes_.regions().size() == 2; })) << "none is lost";
  EXPECT_EQ(nodes_.regions()[1].x_offset, 50u) << "the newest one";
  ASSERT_TRUE(link_.facts().drawn);
  EXPECT_EQ(link_.facts().drawn->region.x(), 50);
  nodes_.open("region");
  EXPECT_TRUE(waitFor([this] { return !link_.facts().drawn; }));
}

TEST_F(ScreenAnswers, WhatIsEngagedAfterStopIsDisengagedOnceMore) {
  nodes_.close("engage");
  link_.engage(true);
  ASSERT_TRUE(waitFor([this] { return nodes_.engages == 1; }));
  link_.stop();
  ASSERT_TRUE(isAnswered("STOP"));
  EXPECT_EQ(nodes_.disengages, 1) << "STOP does not wait for the answer to Engage, nor take it for its own";
  nodes_.open("engage");
  EXPECT_TRUE(waitFor([this] { return nodes_.disengages == 2; }));
  EXPECT_TRUE(isAnswered("Disengage, since Engage came late"));
}

TEST_F(ScreenAnswers, WhatIsEnabledAfterDisableIsDisabledOnceMore) {
  nodes_.close("enable");
  link_.enable();
  ASSERT_TRUE(waitFor([this] { return nodes_.enables == 1; }));
  link_.disable();
  ASSERT_TRUE(isAnswered("Disable"));
  nodes_.open("enable");
  EXPECT_TRUE(waitFor([this] { return nodes_.disables == 2; }));
  EXPECT_TRUE(isAnswered("Disable, since Enable came late"));
}

// The window says WAITING then, and not that the new one does not speak any more.
TEST(ScreenLink, ANodeInPlaceOfOneThatHasEndedHasNotSpokenYet) {
  ros::NodeHandle node;
  screen::RosLink link([] {}, "again");
  const auto tracker = [&] { return link.facts().tracker; };
  {
    ros::Publisher state = node.advertise<TrackerState>("again/tracker/state", 1, true);
    state.publish(TrackerState());
    ASSERT_TRUE(waitFor([&] { return tracker().connected && tracker().heard_at >= 0.0; }));
  }
  ASSERT_TRUE(waitFor([&] { return !tracker().connected && steadyNow() - tracker().heard_at > 1.0; }));
  EXPECT_GE(tracker().heard_at, 0.0) << "it was there";
  ros::Publisher state = node.advertise<TrackerState>("again/tracker/state", 1, true);
  ASSERT_TRUE(waitFor([&] { return tracker().connected; }));
  EXPECT_LT(tracker().heard_at, 0.0);
  state.publish(TrackerState());
  EXPECT_TRUE(waitFor([&] { return tracker().heard_at >= 0.0; }));
}

// Its connection ends, but nobody tells roscpp that the node has: what the band says has to come from what it hears.
TEST(ScreenLink, ATrackerThatIsKilledIsNotShownAsIfItTracked) {
  test_support::ImageFeed camera;
  camera.show(test_support::ImageFeed::tissue({640, 480}));
  test::ChildProcess tracker(TRACKER, {"__ns:=killed", "__name:=tracker", "image:=/camera/image_raw"});
  screen::RosLink link([] {}, "killed");
  const auto word = [&] { return trackerBand(link.facts(), steadyNow()).word; };
  ASSERT_TRUE(waitFor([&] { return word() == "IDLE" && link.facts().tracker.result_at >= 0.0; })) << word();
  link.tracker().selectRegion(QRect(250, 170, 140, 140));
  ASSERT_TRUE(waitFor([&] { return word() == "TRACKING"; })) << word() << link.facts().answer.text;
  tracker.kill(SIGKILL);
  ASSERT_TRUE(waitFor([&] { return word() != "TRACKING"; }));
  EXPECT_EQ(word(), "NO RESULT");
  EXPECT_EQ(link.facts().tracker.state, "TRACKING") << "its last word";
  EXPECT_TRUE(waitFor([&] { return word() == "SILENT"; })) << word();
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "screen_answers_test", 6);
}
