// The screen's window, with real events of an X server, against nodes that say what the test wants.
#include <diagnostic_msgs/DiagnosticArray.h>

#include <QStyleOptionButton>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "screen/task_words.h"
#include "system/aesop/child_process.h"
#include "system/screen/display_text.h"
#include "system/screen/screen_window_fixture.h"

namespace laparoscope_servo {
namespace {

using test_support::hands;
using test_support::kOriginal;
using test_support::moveTo;
using test_support::ScreenWindow;
using test_support::waitFor;

TEST_F(ScreenWindow, ARegionIsDrawnWithinOnePixelOfTheScreenAtAnySize) {
  const QRect wanted(310, 170, 403, 287);
  for (const QSize& size : {QSize(1280, 800), QSize(1024, 768), QSize(1500, 760)}) {
    show(size);
    EXPECT_EQ(screen_->size(), size) << "nothing of it needs more room";
    ASSERT_TRUE(waitFor([&] { return screen_->size() == size && isColoured(); }));
    nodes_.forget();
    hands(moveTo(onDisplay(kOriginal, {100, 100})) + "click 1 click --repeat 2 1");
    ASSERT_TRUE(draws(wanted));
    ASSERT_EQ(nodes_.regions().size(), 1u) << "clicks draw nothing";
    const sensor_msgs::RegionOfInterest region = nodes_.regions()[0];
    const double pixel = std::max(1.0, pixelOfDisplay(kOriginal));
    EXPECT_LE(std::abs(static_cast<double>(region.x_offset) - wanted.x()), pixel);
    EXPECT_LE(std::abs(static_cast<double>(region.y_offset) - wanted.y()), pixel);
    EXPECT_LE(std::abs(static_cast<double>(region.x_offset + region.width) - (wanted.x() + 403)), pixel);
    EXPECT_LE(std::abs(static_cast<double>(region.y_offset + region.height) - (wanted.y() + 287)), pixel);
  }
}

// The room that its style leaves the text of a button, less what the text needs: negative where it is cut.
QSize roomLeft(const QPushButton& button) {
  QStyleOptionButton option;
  option.initFrom(&button);
  option.text = button.text();
  const QRect contents = button.style()->subElementRect(QStyle::SE_PushButtonContents, &option, &button);
  const QFontMetrics font = button.fontMetrics();
  return {contents.width() - font.size(Qt::TextShowMnemonic, button.text()).width(), contents.height() - font.height()};
}

TEST_F(ScreenWindow, NoNameOfAButtonIsCutAtAnySize) {
  nodes_.change([](TrackerState&, ControllerState& controller, OperatingState&) { controller.task = "STABILISE"; });
  ASSERT_TRUE(waitFor([this] { return find<QPushButton>("keep_this_view").isVisible(); })) << "one more button";
  auto& tabs = find<QTabWidget>("tabs");
  for (const QSize& size : {QSize(1280, 800), QSize(1024, 768), QSize(1500, 760)}) {
    show(size);
    ASSERT_TRUE(waitFor([&] { return screen_->size() == size; }));
    std::set<QString> seen;
    for (int page = 0; page < tabs.count(); ++page) {
      tabs.setCurrentIndex(page);
      QCoreApplication::processEvents();
      for (const QPushButton* button : screen_->findChildren<QPushButton*>()) {
        if (!button->isVisible() || button->text().isEmpty()) continue;
        seen.insert(button->text());
        const QSize room = roomLeft(*button);
        EXPECT_GE(room.width(), 0) << button->text().toStdString() << " at a width of " << size.width();
        EXPECT_GE(room.height(), 0) << button->text().toStdString() << " at a height of " << size.height();
      }
    }
    for (const screen::TaskWords& words : screen::taskWords()) {
      EXPECT_EQ(seen.count(QString::fromStdString(words.name)), 1u) << words.name;
    }
  }
  tabs.setCurrentIndex(0);
}

TEST_F(ScreenWindow, TheBandsSayWhatTheNodesSay) {
  const struct {
    const char *tracker, *controller, *robot;
  } states[] = {{"TRACKING", "SERVO", "ENABLED"}, {"LOST", "HOLD", "PAUSED"}, {"SEARCHING", "FAULT", "FAULT"}};
  for (const auto& state : states) {
    nodes_.change([&](TrackerState& tracker, ControllerState& controller, OperatingState& robot) {
      tracker.state = state.tracker;
      controller.state = state.controller;
      robot.state = state.robot;
    });
    EXPECT_TRUE(waitFor([&] {
      return word("Tracker") == state.tracker && word("Controller") == state.controller && word("Robot") == state.robot;
    })) << state.tracker;
  }
}

TEST_F(ScreenWindow, ARegionIsJudgedWhileItIsDrawnAndNothingIsSelectedByIt) {
  const auto draws = [this](int width) {
    hands(moveTo(onDisplay(kOriginal, {300, 200})) + "mousedown 1 " + moveTo(onDisplay(kOriginal, {310, 210})) +
          moveTo(onDisplay(kOriginal, {300.0 + width, 400})));
  };
  const auto painted = [this](const QColor& colour) {
    const QImage shown = image().grab().toImage();
    for (int y = 0; y < shown.height(); ++y) {
      for (int x = 0; x < shown.width(); ++x) {
        const QColor c = shown.pixelColor(x, y);
        if (c == colour) return true;
      }
    }
    return false;
  };
  draws(60);
  EXPECT_TRUE(waitFor([&] { return painted(QColor(0xff, 0x70, 0x60)); })) << "refused while it is drawn";
  hands(moveTo(onDisplay(kOriginal, {700, 400})));
  EXPECT_TRUE(waitFor([&] { return painted(QColor(0x5c, 0xf0, 0x8c)) && !painted(QColor(0xff, 0x70, 0x60)); }))
      << "now it would be taken";
  EXPECT_GE(nodes_.checks, 2);
  EXPECT_TRUE(nodes_.regions().empty());
  hands("click 3 mouseup 1");
  waitFor([&] { return !painted(QColor(0x5c, 0xf0, 0x8c)); });
  EXPECT_TRUE(nodes_.regions().empty()) << "the right button gives it up";
}

TEST_F(ScreenWindow, ARegionThatTheTrackerOffersIsTakenByAClickInIt) {
  ASSERT_TRUE(draws({300, 200, 60, 200}));
  // To another place each time, for Qt tells of no other move.
  auto isOffered = [this, aside = 0]() mutable {
    aside = 4 - aside;
    hands(moveTo(onDisplay(kOriginal, {380.0 + aside, 300})));
    waitFor([] { return false; }, 0.1);
    return image().cursor().shape() == Qt::PointingHandCursor;
  };
  // A busy machine makes the picture old for a moment, and then nothing can be taken.
  const auto takes = [&](const std::string& act, const std::function<bool()>& is_taken) {
    return waitFor([&] {
      if (isOffered()) hands(act);
      return waitFor(is_taken, 2.0);
    });
  };
  ASSERT_TRUE(takes("click 1", [this] { return nodes_.regions().size() == 2; }))
      << "what was drawn was refused, with another one that would do";
  EXPECT_EQ(nodes_.regions()[1].width, 100u);
  EXPECT_TRUE(waitFor([&] { return !isOffered(); })) << "it was taken";

  // Lost in its first second: cut from the picture in which it was selected.
  nodes_.change([](TrackerState& tracker, ControllerState&, OperatingState&) {
    tracker.state = TrackerState::SEARCHING;
    tracker.reason = "correlation 0.2; it was not held in its first second; 350,250,100,100 would do";
    tracker.reference_stamp = ros::Time(5.0);
    tracker.proposal.x_offset = 350;
    tracker.proposal.y_offset = 250;
    tracker.proposal.width = tracker.proposal.height = 100;
  });
  ASSERT_TRUE(takes("click 1", [this] { return nodes_.frozenRegions().size() == 1; }));
  EXPECT_EQ(nodes_.frozenRegions()[0].x_offset, 350u);
}

TEST_F(ScreenWindow, ARegionIsDrawnInAFrozenPicture) {
  click("freeze");
  const auto amber = [this] {
    return image().grab().toImage().pixelColor(onDisplay(kOriginal, {3, 300}) - image().mapToGlobal(QPoint(0, 0))) ==
           QColor(0xff, 0xb0, 0x20);
  };
  ASSERT_TRUE(waitFor(amber)) << "a frozen picture is marked";
  nodes_.runCamera(false);
  drag(onDisplay(kOriginal, {300, 200}), onDisplay(kOriginal, {600, 400}));
  ASSERT_TRUE(waitFor([this] { return nodes_.frozenRegions().size() == 1; }));
  EXPECT_NEAR(nodes_.frozenRegions()[0].x_offset, 300, pixelOfDisplay(kOriginal) + 1);
  EXPECT_TRUE(nodes_.regions().empty());
  nodes_.runCamera(true);
  EXPECT_TRUE(waitFor([&] { return !amber() && isColoured(); })) << "taken: the live picture returns";
  click("freeze");
  ASSERT_TRUE(waitFor(amber));
  click("stop");
  EXPECT_TRUE(waitFor([&] { return !amber(); })) << "STOP shows what is now";
}

TEST_F(ScreenWindow, AViewIsStoredAndRecalledByItsPicture) {
  find<QTabWidget>("tabs").setCurrentIndex(1);
  auto& name = find<QLineEdit>("view_name");
  auto& list = find<QListWidget>("views");
  ASSERT_TRUE(waitFor([&] { return name.isVisible(); }));
  // A line that comes or goes moves the field away from under the mouse.
  ASSERT_TRUE(waitFor([&] {
    if (!name.hasFocus()) hands(moveTo(centreOf(name)) + "click 1");
    return name.hasFocus();
  }));
  hands("type gallbladder");
  ASSERT_TRUE(waitFor([&] { return name.text() == "gallbladder"; })) << name.text().toStdString();
  click("store_view");
  ASSERT_TRUE(waitFor([&] { return list.count() == 1; }));
  EXPECT_EQ(list.item(0)->text(), "gallbladder");
  hands(moveTo(list.viewport()->mapToGlobal(list.visualItemRect(list.item(0)).center())) + "click 1");
  ASSERT_TRUE(waitFor([&] { return list.currentItem() != nullptr; }));
  EXPECT_TRUE(nodes_.recalled().empty());
  click("recall_view");
  EXPECT_TRUE(waitFor([this] { return nodes_.recalled() == std::vector<std::string>{"gallbladder"}; }));
  find<QTabWidget>("tabs").setCurrentIndex(0);
}

TEST_F(ScreenWindow, ATaskIsExplainedBeforeItIsSelected) {
  auto& promise = find<QLabel>("promise");
  const auto task = [this] { return find<screen::StateBand>("Controller").text().note; };
  ASSERT_TRUE(waitFor([&] { return task() == "Task: Hold region"; })) << task();
  ASSERT_TRUE(promise.text().startsWith("Once engaged, the scope brings the region back"))
      << promise.text().toStdString();
  hands(moveTo(centreOf(find<QPushButton>("centre_tip"))));
  EXPECT_TRUE(waitFor([&] { return promise.text().startsWith("Once engaged, the scope turns to a tip"); }))
      << promise.text().toStdString();
  EXPECT_TRUE(nodes_.tasks().empty()) << "pointing at it selects nothing";
  click("centre_tip");
  EXPECT_TRUE(waitFor([&] { return task() == "Task: Centre tip"; })) << task();
  EXPECT_EQ(nodes_.tasks(), std::vector<std::string>{"CENTRE_TIP"});

  nodes_.change([](TrackerState&, ControllerState& controller, OperatingState&) { controller.engaged = 1; });
  hands(moveTo(centreOf(find<QPushButton>("hold_region"))));
  EXPECT_TRUE(waitFor([&] { return promise.text().startsWith("At once, if pressed, the scope brings"); }))
      << promise.text().toStdString();
  nodes_.refuseTasks(true);
  click("hold_region");
  const auto answer = [this] { return find<QLabel>("answer").text().toStdString(); };
  EXPECT_TRUE(waitFor([&] { return answer() == "Task Hold region: REFUSED. no task 'HOLD_VIEW' here"; })) << answer();
  EXPECT_EQ(task(), "Task: Centre tip") << "the one before goes on";
  nodes_.refuseTasks(false);
}

TEST_F(ScreenWindow, TheViewThatIsToBeHeldIsKeptByAButtonOfItsTask) {
  EXPECT_FALSE(find<QPushButton>("keep_this_view").isVisible());
  click("stabilise");
  ASSERT_TRUE(waitFor([this] { return find<QPushButton>("keep_this_view").isVisible(); }));
  click("keep_this_view");
  EXPECT_TRUE(waitFor([this] { return nodes_.keptViews() == std::vector<std::string>{"[{id: view, motion: []}]"}; }));
  EXPECT_EQ(nodes_.tasks(), std::vector<std::string>{"STABILISE"});
}

TEST_F(ScreenWindow, ADiskThatIsFullWhileACaseIsRecordedIsSeen) {
  auto& recording = find<screen::RecordingBar>("recording");
  EXPECT_FALSE(recording.isVisible()) << "there is no recorder";
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10);
  diagnostic_msgs::DiagnosticArray message;
  message.status.resize(1);
  message.status[0].name = "recorder: recording";
  const auto says = [&](int level, const std::string& text, const std::string& word) {
    message.status[0].level = static_cast<std::int8_t>(level);
    message.status[0].message = text;
    return waitFor([&] {
      publisher.publish(message);
      return recording.isVisible() && recording.text().word == word;
    });
  };
  EXPECT_TRUE(says(diagnostic_msgs::DiagnosticStatus::OK, "recording", "RECORDING"));
  EXPECT_TRUE(says(diagnostic_msgs::DiagnosticStatus::ERROR, "nothing is recorded: 3 MB are free", "NOT RECORDING"));
  EXPECT_EQ(recording.text().sentence, "nothing is recorded: 3 MB are free");
}

TEST_F(ScreenWindow, ACameraThatDiesIsSeen) {
  nodes_.runCamera(false);
  EXPECT_TRUE(waitFor([this] { return !isColoured(); })) << "the last picture does not stay as if live";
  nodes_.runCamera(true);
  EXPECT_TRUE(waitFor([this] { return isColoured(); }));
}

// The program itself, where there is no master: it is there, and ends when it is asked to.
TEST(ScreenProgram, ShowsItsWindowWithoutAMasterAndEnds) {
  test::ChildProcess program("/usr/bin/env", {"ROS_MASTER_URI=http://localhost:1", LAPAROSCOPE_SCREEN});
  const auto there = [] {
    return std::system("xdotool search --onlyvisible --name '^Laparoscope$' >/dev/null 2>&1") == 0;
  };
  ASSERT_TRUE(waitFor(there));
  hands("key Escape");
  program.kill(SIGINT);
  EXPECT_EQ(program.exitStatus(30.0), 0);
}

// A display of 1024x768 at a scale of 200 %: half of the screen is out of sight, but not STOP.
TEST(ScreenProgram, OnASmallDisplayStopStaysInSight) {
  const std::string before = std::getenv("DISPLAY");
  {
    const test_support::VirtualDisplay display("1024x768");
    test_support::FakeNodes nodes;
    test::ChildProcess program("/usr/bin/env", {"QT_SCALE_FACTOR=2", LAPAROSCOPE_SCREEN});
    const std::string text = test_support::readUntil({"STOP"});
    EXPECT_EQ(test_support::notRead(text, {"STOP"}), "") << text;
    EXPECT_TRUE(waitFor([&] { return nodes.connected(); }));
    hands("mousemove 500 730 mousedown 1 mouseup 1");  // near the lower edge
    EXPECT_TRUE(waitFor([&] { return nodes.robot_stops >= 1 && nodes.controller_stops >= 1; }));
    program.kill(SIGINT);
    EXPECT_EQ(program.exitStatus(30.0), 0);
  }
  ::setenv("DISPLAY", before.c_str(), 1);
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runScreenTests(argc, argv, "screen_window_test");
}