// What the screen holds and stops: STOP, the dead-man switch and the sliders, with real events of an X server.
#include <QMenu>
#include <cstdlib>

#include "system/aesop/child_process.h"
#include "system/screen/screen_window_fixture.h"

namespace laparoscope_servo {
namespace {

using test_support::hands;
using test_support::moveTo;
using test_support::ScreenWindow;
using test_support::waitFor;

const QSize kOriginal(1280, 720);

TEST_F(ScreenWindow, StopsByItsButtonAndByKeysFromAnyFocus) {
  click("stop");
  EXPECT_TRUE(isStopped(1)) << nodes_.robot_stops << nodes_.controller_stops << nodes_.disables << nodes_.disengages;
  const auto answer = [this] { return find<QLabel>("answer").text().toStdString(); };
  EXPECT_TRUE(waitFor([&] { return answer() == "STOP: done. The arm is disabled. The controller is disengaged."; }))
      << answer();
  hands("key Escape");
  EXPECT_TRUE(isStopped(2));
  const auto other = otherWindow();
  focus(*other);
  hands("key Pause");
  EXPECT_TRUE(isStopped(3)) << "the focus is in another window";
  focus(*screen_);
  QMenu menu;
  menu.addAction("a");
  menu.popup(QPoint(600, 300));
  ASSERT_TRUE(waitFor([&] { return menu.isVisible() && QApplication::activePopupWidget() == &menu; }));
  hands("key Pause");
  EXPECT_TRUE(isStopped(4)) << "a menu is open";
  menu.close();
}

TEST_F(ScreenWindow, StopsWhileAServiceHangs) {
  nodes_.close("enable");
  click("enable");
  ASSERT_TRUE(waitFor([this] { return nodes_.enables == 1; }));
  nodes_.change([](TrackerState&, ControllerState&, OperatingState& robot) { robot.state = "PAUSED"; });
  EXPECT_TRUE(waitFor([this] { return word("Robot") == "PAUSED"; })) << "the screen lives";
  click("stop");
  EXPECT_TRUE(isStopped(1));
  nodes_.open("enable");
}

TEST_F(ScreenWindow, TheDeadManEndsWithTheMouseButton) {
  holdDeadMan();
  hands("mouseup 1");
  EXPECT_TRUE(deadManIs(false));
  EXPECT_TRUE(waitFor([this] { return isSilent(); })) << "who holds another switch is not disturbed";
}

TEST_F(ScreenWindow, TheDeadManEndsWithTheFocus) {
  holdDeadMan();
  const auto other = otherWindow();
  focus(*other);
  EXPECT_TRUE(deadManIs(false));
  focus(*screen_);
  EXPECT_TRUE(waitFor([this] { return isSilent(); })) << "and stays so";
  EXPECT_FALSE(nodes_.deadMan().back());
  hands("mouseup 1");
}

TEST_F(ScreenWindow, TheDeadManEndsWhenTheWindowIsMinimised) {
  const test::ChildProcess manager("/usr/bin/env", {"cwm", "-c", "/dev/null"});
  const std::string window = std::to_string(screen_->winId());
  ASSERT_TRUE(waitFor([&] {  // it takes the window, and gives it the focus when it is asked to
    return std::system(("xdotool windowactivate " + window + " 2>/dev/null").c_str()) == 0 && screen_->isActiveWindow();
  }));
  holdDeadMan();
  hands("windowminimize " + window);
  EXPECT_TRUE(deadManIs(false));
  EXPECT_TRUE(waitFor([this] { return screen_->isMinimized(); }));
  hands("windowactivate " + window);
  EXPECT_TRUE(waitFor([this] { return !screen_->isMinimized() && screen_->isActiveWindow(); }));
  EXPECT_TRUE(waitFor([this] { return isSilent(); })) << "the button that is still down does not take it again";
  EXPECT_FALSE(nodes_.deadMan().back());
  hands("mouseup 1");
}

TEST_F(ScreenWindow, TheDeadManEndsWithAPopup) {
  holdDeadMan();
  QMenu menu;
  menu.addAction("a");
  menu.popup(QPoint(600, 300));
  EXPECT_TRUE(deadManIs(false));
  menu.close();
  hands("mouseup 1");
}

TEST_F(ScreenWindow, TheDeadManEndsWithStop) {
  holdDeadMan();
  hands("key Escape");
  EXPECT_TRUE(deadManIs(false));
  EXPECT_TRUE(isStopped(1));
  hands("mouseup 1");
}

// Nobody takes in events meanwhile; the fakes live in other threads.
TEST_F(ScreenWindow, TheDeadManEndsWhenTheGuiHangs) {
  holdDeadMan();
  const double until = steadyNow() + 20.0;
  while (nodes_.deadMan().back() && steadyNow() < until) ros::WallDuration(0.01).sleep();
  EXPECT_FALSE(nodes_.deadMan().back());
  EXPECT_TRUE(waitFor([this] { return isSilent(); })) << "a GUI that comes back does not take it again";
  EXPECT_FALSE(nodes_.deadMan().back());
  hands("mouseup 1");
}

TEST_F(ScreenWindow, TheDeadMansKeyHoldsThroughItsRepetition) {
  hands(moveTo(onDisplay(kOriginal, {100, 100})) + "click 1");  // the focus is within the screen
  // 1.5 s: the X server repeats after 0.5 s.
  hold("keydown F9", "keyup F9", [this] { return isRepeated() && nodes_.deadMan().size() >= 30; });
  hands("keyup F9");
  EXPECT_TRUE(deadManIs(false));
}

TEST_F(ScreenWindow, ASliderDrivesWhileItIsHeldAndReturnsToZero) {
  nodes_.change([](TrackerState&, ControllerState& controller, OperatingState&) { controller.task = "MANUAL"; });
  auto& pan = find<screen::VelocitySlider>("Pan");
  ASSERT_TRUE(waitFor([&] { return pan.isEnabled(); }));
  const QPoint at = centreOf(pan);
  hands(moveTo(at) + "click 4 click 5 click 4");
  hands("key Right key Right key Prior");
  EXPECT_TRUE(isSilent()) << "neither wheel nor keys";
  const auto drives = [this] { return !nodes_.manual().empty() && nodes_.manual().back().pan > 0.01; };
  const std::string push = moveTo(at) + "mousedown 1 " + moveTo(at + QPoint(60, 0));
  hold(push, "mouseup 1", drives);
  EXPECT_LE(nodes_.manual().back().pan, 0.1);
  EXPECT_EQ(nodes_.manual().front().pan, 0.0) << "it begins at rest";
  EXPECT_EQ(nodes_.manual().back().insertion, 0.0);
  hands("mouseup 1");
  ASSERT_TRUE(waitFor([this] { return nodes_.manual().back().pan == 0.0; }));
  EXPECT_TRUE(waitFor([&] { return pan.share() == 0.0; }));
  EXPECT_TRUE(waitFor([this] { return isSilent(); }));
  EXPECT_EQ(nodes_.manual().back().pan, 0.0);

  hold(push, "mouseup 1", drives);
  const double until = steadyNow() + 20.0;
  while (nodes_.manual().back().pan != 0.0 && steadyNow() < until) ros::WallDuration(0.01).sleep();
  EXPECT_EQ(nodes_.manual().back().pan, 0.0) << "a GUI that hangs";
  hands("mouseup 1");
}

}  // namespace
}  // namespace laparoscope_servo
