#include "ros/joystick/stick.h"

#include <gtest/gtest.h>

namespace laparoscope_servo {
namespace {

constexpr int kPan = 0;
constexpr int kTilt = 1;
constexpr int kSpin = 3;
constexpr int kInsertion = 4;
constexpr int kButton = 5;

class StickTest : public testing::Test {
 protected:
  void axis(int number, double share) {
    const auto value = static_cast<std::int16_t>(share * 32767.0);
    let_go_ = stick_.event({JoystickEvent::Kind::kAxis, false, static_cast<std::uint8_t>(number), value}, now_);
  }
  void button(int number, bool pressed) {
    const std::int16_t value = pressed ? 1 : 0;
    let_go_ = stick_.event({JoystickEvent::Kind::kButton, false, static_cast<std::uint8_t>(number), value}, now_);
  }
  // As the kernel tells it when the device is opened.
  void plugIn(bool pressed = false, double pan = 0.0) {
    for (const int number : {kTilt, kSpin, kInsertion}) axis(number, 0.0);
    axis(kPan, pan);
    button(kButton, pressed);
  }
  Stick::Words turn() {
    now_ += 0.05;
    return stick_.cycle(now_);
  }
  // Released and pressed again, the button counts.
  void expectTakenAnew() {
    button(kButton, false);
    turn();
    button(kButton, true);
    EXPECT_EQ(turn().dead_man, (std::vector<bool>{false, true}));
  }
  void expectSilence(int turns = 5) {
    for (int k = 0; k < turns; ++k) {
      const Stick::Words words = turn();
      for (const bool pressed : words.dead_man) EXPECT_FALSE(pressed);
      EXPECT_TRUE(!words.manual || words.manual->isZero());
    }
  }
  // After farewells: not a word.
  void expectNoWord() {
    const Stick::Words words = turn();
    EXPECT_TRUE(words.dead_man.empty());
    EXPECT_FALSE(words.manual);
  }

  StickConfig config_;
  Stick stick_{config_};
  double now_ = 100.0;
  bool let_go_ = false;
};

TEST_F(StickTest, SaysNothingWithoutAJoystickAndNothingWhileNobodyHoldsIt) {
  expectNoWord();
  EXPECT_EQ(stick_.problem(), "no joystick");
  plugIn();
  expectNoWord();
  EXPECT_EQ(stick_.problem(), "");
}

TEST_F(StickTest, HeldItSaysReleasedOnceThenHeldAndStopsWithTheRelease) {
  plugIn();
  turn();
  button(kButton, true);
  EXPECT_FALSE(let_go_);
  EXPECT_EQ(turn().dead_man, (std::vector<bool>{false, true}));
  EXPECT_EQ(turn().dead_man, std::vector<bool>{true});
  EXPECT_TRUE(stick_.isHeld());
  button(kButton, false);
  EXPECT_TRUE(let_go_) << "to be said at once";
  for (int k = 0; k < 3; ++k) EXPECT_EQ(turn().dead_man, std::vector<bool>{false});
  EXPECT_TRUE(turn().dead_man.empty());
}

TEST_F(StickTest, AxesBecomeVelocitiesBeyondTheNeutralShare) {
  plugIn();
  turn();
  button(kButton, true);
  auto manual = turn().manual;
  ASSERT_TRUE(manual);
  EXPECT_TRUE(manual->isZero()) << "first a zero: the controller wants to see the stick at rest";
  axis(kPan, 1.0);
  axis(kTilt, -1.0);
  axis(kSpin, 0.55);
  axis(kInsertion, 0.09);
  manual = turn().manual;
  ASSERT_TRUE(manual);
  EXPECT_DOUBLE_EQ(manual->pan, 0.1) << "right";
  EXPECT_DOUBLE_EQ(manual->tilt, 0.1) << "up is negative for the kernel";
  EXPECT_NEAR(manual->spin, 0.05, 1e-5);
  EXPECT_EQ(manual->insertion, 0.0) << "within the neutral share";
  axis(kPan, 0.0);
  axis(kTilt, 0.0);
  axis(kSpin, 0.0);
  EXPECT_TRUE(let_go_);
  EXPECT_TRUE(turn().manual->isZero());
}

TEST_F(StickTest, LettingTheButtonGoEndsTheDriveWithZeros) {
  plugIn();
  turn();
  button(kButton, true);
  turn();
  axis(kPan, 1.0);
  EXPECT_EQ(turn().manual->pan, 0.1);
  button(kButton, false);
  for (int k = 0; k < 10; ++k) {
    const auto manual = turn().manual;
    ASSERT_TRUE(manual) << k;
    EXPECT_TRUE(manual->isZero()) << k;
  }
  expectNoWord();
}

TEST_F(StickTest, AStickThatIsDeflectedWhenTheButtonIsTakenHasToBeReleasedFirst) {
  plugIn();
  turn();
  axis(kPan, 0.5);
  turn();
  button(kButton, true);
  for (int k = 0; k < 5; ++k) EXPECT_FALSE(turn().manual);
  EXPECT_NE(stick_.problem().find("release the stick"), std::string::npos);
  axis(kPan, 0.0);
  EXPECT_TRUE(turn().manual->isZero());
  EXPECT_EQ(stick_.problem(), "");
  axis(kPan, 0.5);
  EXPECT_GT(turn().manual->pan, 0.0);
}

TEST_F(StickTest, WhatIsHeldAtTheStartCountsForNothing) {
  plugIn(true);
  expectSilence();
  EXPECT_NE(stick_.problem().find("from the start"), std::string::npos);
  expectTakenAnew();
}

TEST_F(StickTest, WhatIsDeflectedAtTheStartKeepsTheButtonSilentToo) {
  plugIn(false, 0.5);
  turn();
  button(kButton, true);
  expectSilence();
  axis(kPan, 0.0);
  expectSilence();
  expectTakenAnew();
}

TEST_F(StickTest, AJoystickThatLacksAnAxisIsSilent) {
  for (const int number : {kPan, kTilt, kSpin}) axis(number, 0.0);
  button(kButton, false);
  turn();
  button(kButton, true);
  expectSilence();
  EXPECT_NE(stick_.problem().find("axis 4"), std::string::npos) << stick_.problem();
}

TEST_F(StickTest, WithoutAnyEventItIsOutOfReachUntilAllWasReleased) {
  plugIn();
  turn();
  button(kButton, true);
  turn();
  axis(kPan, 1.0);
  for (int k = 0; k < 99; ++k) {
    const Stick::Words words = turn();
    EXPECT_EQ(words.dead_man, std::vector<bool>{true}) << k;
    EXPECT_EQ(words.manual->pan, 0.1) << k;
  }
  now_ += 0.1;
  expectSilence();
  EXPECT_NE(stick_.problem().find("out of reach"), std::string::npos);
  axis(kPan, 0.9);
  expectSilence();
  axis(kPan, 0.0);
  expectSilence();
  expectTakenAnew();
}

TEST_F(StickTest, EventsOfAnyAxisShowThatItIsInReach) {
  plugIn();
  turn();
  button(kButton, true);
  turn();
  for (int k = 0; k < 400; ++k) {
    if (k % 50 == 0) axis(kInsertion, 0.01 + 0.001 * k / 50);
    ASSERT_EQ(turn().dead_man, std::vector<bool>{true}) << k;
  }
}

TEST_F(StickTest, AtRestItMayBeStillForEver) {
  plugIn();
  turn();
  now_ += 1e6;
  turn();
  EXPECT_EQ(stick_.problem(), "");
  button(kButton, true);
  EXPECT_EQ(turn().dead_man, (std::vector<bool>{false, true}));
}

TEST_F(StickTest, UnpluggedWhileHeldItLetsGoAndPluggedInHeldItStaysSilent) {
  plugIn();
  turn();
  button(kButton, true);
  turn();
  axis(kPan, 1.0);
  turn();
  stick_.gone();
  const Stick::Words words = turn();
  EXPECT_EQ(words.dead_man, std::vector<bool>{false});
  EXPECT_TRUE(words.manual->isZero());
  expectSilence(12);
  expectNoWord();
  EXPECT_EQ(stick_.problem(), "no joystick");
  plugIn(true, 1.0);
  for (int k = 0; k < 5; ++k) expectNoWord();
}

TEST_F(StickTest, APedalIsHeldLikeTheButton) {
  config_.pedal_axis = 2;
  stick_ = Stick(config_);
  axis(2, -1.0);
  plugIn();
  expectNoWord();
  axis(2, 0.4);
  EXPECT_TRUE(turn().dead_man.empty()) << "70 % of its way";
  axis(2, 0.6);
  EXPECT_EQ(turn().dead_man, (std::vector<bool>{false, true}));
  axis(2, 0.4);
  EXPECT_TRUE(let_go_);
  EXPECT_EQ(turn().dead_man, std::vector<bool>{false});

  config_.pedal_reversed = true;
  stick_ = Stick(config_);
  axis(2, 1.0);
  plugIn();
  turn();
  axis(2, -1.0);
  EXPECT_EQ(turn().dead_man, (std::vector<bool>{false, true}));
}

TEST_F(StickTest, ADeviceWithAPedalAloneDrivesNothing) {
  for (auto* axis : {&config_.pan, &config_.tilt, &config_.spin, &config_.insertion}) axis->axis = -1;
  config_.dead_man_button = -1;
  config_.pedal_button = 0;
  EXPECT_TRUE(validate(config_).empty());
  stick_ = Stick(config_);
  button(0, false);
  turn();
  button(0, true);
  const Stick::Words words = turn();
  EXPECT_EQ(words.dead_man, (std::vector<bool>{false, true}));
  EXPECT_FALSE(words.manual);
  EXPECT_EQ(stick_.problem(), "");
}

TEST_F(StickTest, WithoutASwitchTheAxesMaySpeakWhenThatIsAskedFor) {
  config_.dead_man_button = -1;
  EXPECT_EQ(validate(config_).size(), 1u);
  config_.only_while_held = false;
  EXPECT_TRUE(validate(config_).empty());
  stick_ = Stick(config_);
  plugIn();
  EXPECT_TRUE(turn().manual->isZero());
  axis(kPan, -1.0);
  EXPECT_EQ(turn().manual->pan, -0.1);
}

}  // namespace
}  // namespace laparoscope_servo
