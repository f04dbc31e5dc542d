// What a hand holds, and everything that has to end the hold.
#include <gtest/gtest.h>

#include <QApplication>
#include <QMenu>
#include <QVBoxLayout>
#include <QtTest>
#include <vector>

#include "ros/common/clocks.h"
#include "screen/dead_man_button.h"
#include "screen/velocity_slider.h"

namespace laparoscope_servo::screen {
namespace {

class HoldWidgets : public testing::Test {
 protected:
  HoldWidgets() {
    auto* layout = new QVBoxLayout(&window_);
    layout->addWidget(dead_man_ = new DeadManButton(
                          dead_man_control_, [this] { ++changes_; }, &window_));
    layout->addWidget(
        slider_ = new VelocitySlider(
            "Pan", "left", "right", slider_control_, [this] { shares_.push_back(slider_->share()); }, [] {}, &window_));
    window_.resize(400, 200);
    window_.show();
    window_.activateWindow();
    EXPECT_TRUE(QTest::qWaitForWindowActive(&window_));
    dead_man_->setWanted(true);
  }

  QPoint centreOf(QWidget* widget) { return widget->mapTo(&window_, widget->rect().center()); }
  // By the window, as a real one: Qt then knows that the button is down.
  void press(QWidget* widget, Qt::MouseButton button = Qt::LeftButton) {
    QTest::mousePress(window_.windowHandle(), button, {}, centreOf(widget));
  }
  void release(QWidget* widget, Qt::MouseButton button = Qt::LeftButton) {
    QTest::mouseRelease(window_.windowHandle(), button, {}, centreOf(widget));
  }
  bool deadManHeld() {
    EXPECT_EQ(dead_man_->isHeld(), dead_man_control_.isHeld(steadyNow()));
    return dead_man_->isHeld();
  }
  void hold() {
    press(dead_man_);
    dead_man_->beat();
    ASSERT_TRUE(deadManHeld());
  }

  HeldControl dead_man_control_, slider_control_;
  QWidget window_;
  DeadManButton* dead_man_ = nullptr;
  VelocitySlider* slider_ = nullptr;
  int changes_ = 0;
  std::vector<double> shares_;
};

TEST_F(HoldWidgets, TheDeadManIsHeldByTheLeftButtonAlone) {
  hold();
  EXPECT_EQ(changes_, 1);
  release(dead_man_);
  EXPECT_FALSE(deadManHeld());
  EXPECT_EQ(changes_, 2);
  for (const Qt::MouseButton button : {Qt::RightButton, Qt::MiddleButton}) {
    press(dead_man_, button);
    EXPECT_FALSE(deadManHeld());
    release(dead_man_, button);
  }
  hold();
  press(dead_man_, Qt::RightButton);
  EXPECT_FALSE(deadManHeld()) << "two buttons are no clear word";
  release(dead_man_, Qt::RightButton);
  release(dead_man_);
}

TEST_F(HoldWidgets, WhatNobodyListensToCannotBeHeld) {
  hold();
  dead_man_->setWanted(false);
  EXPECT_FALSE(deadManHeld());
  release(dead_man_);
  press(dead_man_);
  EXPECT_FALSE(deadManHeld());
  release(dead_man_);
}

TEST_F(HoldWidgets, AnotherWindowWithTheFocusEndsIt) {
  hold();
  QWidget other;
  other.show();
  other.activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(&other));
  EXPECT_FALSE(deadManHeld());
  window_.activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(&window_));
  dead_man_->beat();
  EXPECT_FALSE(deadManHeld()) << "the focus that comes back does not bring it back";
  release(dead_man_);
}

TEST_F(HoldWidgets, APopupEndsIt) {
  hold();
  QMenu menu;
  menu.addAction("a");
  menu.popup(QPoint(10, 10));
  dead_man_->beat();
  EXPECT_FALSE(deadManHeld());
  menu.close();
  dead_man_->beat();
  EXPECT_FALSE(deadManHeld());
  release(dead_man_);
}

TEST_F(HoldWidgets, AWindowThatIsMinimisedOrHiddenEndsIt) {
  hold();
  window_.showMinimized();
  dead_man_->beat();
  EXPECT_FALSE(deadManHeld());
  release(dead_man_);
  window_.showNormal();
  window_.activateWindow();
  ASSERT_TRUE(QTest::qWaitForWindowActive(&window_));
  hold();
  window_.hide();
  EXPECT_FALSE(deadManHeld());
}

// A menu of somebody else may have taken it.
TEST_F(HoldWidgets, AReleaseThatWentElsewhereIsSeenByTheNextBeat) {
  hold();
  QWidget other;
  other.show();
  QTest::mouseRelease(other.windowHandle(), Qt::LeftButton, {}, QPoint(1, 1));
  if (dead_man_->isHeld()) dead_man_->beat();
  EXPECT_FALSE(deadManHeld());
}

TEST_F(HoldWidgets, AGuiThatHangsEndsIt) {
  hold();
  const double until = steadyNow() + 1.5 * kPatience;
  while (steadyNow() < until) {
  }
  EXPECT_FALSE(dead_man_control_.isHeld(steadyNow())) << "as the thread that sends sees it";
  dead_man_->beat();
  EXPECT_FALSE(dead_man_->isHeld());
  EXPECT_FALSE(dead_man_control_.isHeld(steadyNow())) << "a hand has to take it anew";
  release(dead_man_);
}

TEST_F(HoldWidgets, TheKeyHoldsThroughItsRepetitionAndEndsWithItsRelease) {
  dead_man_->keyPressed();
  for (int k = 0; k < 5; ++k) {
    dead_man_->keyReleased();
    dead_man_->keyPressed();
    QTest::qWait(40);
    dead_man_->beat();
    ASSERT_TRUE(deadManHeld());
  }
  dead_man_->keyReleased();
  EXPECT_TRUE(QTest::qWaitFor([this] { return !dead_man_->isHeld(); }));
  EXPECT_FALSE(deadManHeld());
}

TEST_F(HoldWidgets, AKeyThatStaysDownDoesNotTakeItAgain) {
  dead_man_->keyPressed();
  ASSERT_TRUE(deadManHeld());
  dead_man_->letGo();
  dead_man_->keyReleased();  // X11's repetition
  dead_man_->keyPressed();
  EXPECT_FALSE(deadManHeld());
}

TEST_F(HoldWidgets, TheSliderIsMovedByTheHeldMouseAloneAndReturnsToZero) {
  const QPoint at = centreOf(slider_) + QPoint(60, 0);
  QTest::mousePress(window_.windowHandle(), Qt::LeftButton, {}, at);
  EXPECT_TRUE(slider_->isHeld());
  EXPECT_EQ(slider_->share(), 0.0) << "wherever it is taken, it begins at zero";
  QTest::mouseMove(window_.windowHandle(), at + QPoint(40, 0));
  EXPECT_GT(slider_->share(), 0.1);
  EXPECT_LT(slider_->share(), 1.0);
  QTest::mouseMove(window_.windowHandle(), at - QPoint(900, 0));
  EXPECT_EQ(slider_->share(), -1.0);
  QTest::mouseRelease(window_.windowHandle(), Qt::LeftButton, {}, at);
  EXPECT_FALSE(slider_->isHeld());
  EXPECT_EQ(slider_->share(), 0.0);
  EXPECT_EQ(shares_.back(), 0.0) << "it was told";
}

TEST_F(HoldWidgets, NeitherWheelNorKeyMovesTheSlider) {
  shares_.clear();
  const QPoint at = slider_->rect().center();
  QWheelEvent wheel(at, slider_->mapToGlobal(at), QPoint(), QPoint(0, 120), Qt::NoButton, Qt::NoModifier,
                    Qt::NoScrollPhase, false);
  QApplication::sendEvent(slider_, &wheel);
  slider_->setFocus();
  for (const Qt::Key key : {Qt::Key_Right, Qt::Key_Left, Qt::Key_PageUp, Qt::Key_End, Qt::Key_Space})
    QTest::keyClick(slider_, key);
  QTest::mouseMove(window_.windowHandle(), centreOf(slider_) + QPoint(30, 0));
  EXPECT_TRUE(shares_.empty());
  EXPECT_EQ(slider_->share(), 0.0);
  EXPECT_FALSE(slider_->isHeld());
}

TEST_F(HoldWidgets, ADisabledSliderLetsGo) {
  press(slider_);
  QTest::mouseMove(window_.windowHandle(), centreOf(slider_) + QPoint(50, 0));
  ASSERT_GT(slider_->share(), 0.0);
  slider_->setEnabled(false);
  EXPECT_FALSE(slider_->isHeld());
  EXPECT_EQ(slider_->share(), 0.0);
  release(slider_);
}

}  // namespace
}  // namespace laparoscope_servo::screen
