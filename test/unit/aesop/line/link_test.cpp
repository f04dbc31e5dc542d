#include "laparoscope_servo/aesop/link.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/aesop/fake_controller.h"

namespace laparoscope_servo::aesop {
namespace {

std::vector<Status> receive(Link& link, const Bytes& bytes, double now) {
  std::vector<Status> statuses;
  for (const LinkEvent& event : link.receive(bytes.data(), bytes.size(), now)) {
    if (const auto* status = std::get_if<Status>(&event)) statuses.push_back(*status);
  }
  return statuses;
}

class LinkTest : public ::testing::Test {
 protected:
  void bringUp(double now) {
    link_.opened(now);
    controller_.hear(link_.identify(now));
    receive(link_, controller_.identity(), now + 0.01);
    ASSERT_TRUE(link_.isUp());
  }
  Link link_{SessionConfig(), kDrivenMask};
  FakeController controller_;
};

TEST_F(LinkTest, identifiesAgainAndAgain) {
  EXPECT_EQ(link_.state(), LinkState::kClosed);
  EXPECT_TRUE(link_.identify(0.0).empty());
  link_.opened(0.0);
  int requests = 0;
  for (int k = 0; k < 1000; ++k) {
    const Bytes bytes = link_.identify(0.001 * k);
    if (bytes.empty()) continue;
    ++requests;
    EXPECT_TRUE(std::holds_alternative<Identify>(controller_.hear(bytes).at(0)));
  }
  EXPECT_EQ(requests, 5);
  EXPECT_FALSE(link_.reason().empty());
  receive(link_, controller_.identity(), 1.0);
  EXPECT_TRUE(link_.isUp());
  EXPECT_EQ(link_.reason(), "");
  EXPECT_EQ(link_.model(), "fake");
}

TEST_F(LinkTest, otherJointsKeepItDown) {
  controller_.driven = 0x07;
  link_.opened(0.0);
  receive(link_, controller_.identity(), 0.1);
  EXPECT_FALSE(link_.isUp());
  EXPECT_NE(link_.reason().find("drives 1, 2, 3,"), std::string::npos) << link_.reason();
}

TEST_F(LinkTest, otherVersionKeepsItDown) {
  link_.opened(0.0);
  const Bytes version2 = {0xA5, 0x5A, 0x02, 0x00, 0x06, 0x07, 0x00, 0xB8, 0x7E};
  receive(link_, version2, 0.1);
  EXPECT_FALSE(link_.isUp());
  EXPECT_NE(link_.reason().find("speaks version 2"), std::string::npos) << link_.reason();
  EXPECT_NE(link_.reason().find("version 1"), std::string::npos) << link_.reason();
}

TEST_F(LinkTest, statusBeforeIdentityIsOldNews) {
  link_.opened(0.0);
  EXPECT_TRUE(receive(link_, controller_.say(), 0.1).empty());
  EXPECT_FALSE(link_.isUp());
  EXPECT_FALSE(link_.status().has_value());
}

TEST_F(LinkTest, aStatusIsAsOldAsTheRequestThatItAnswers) {
  bringUp(0.0);
  // A line that holds everything back by 0.2 s, then by more than a status may be old.
  controller_.hear(link_.send(Poll(), 1.0));
  receive(link_, controller_.say(), 1.2);
  EXPECT_NEAR(link_.statusAge(1.25), 0.25, 1e-9);
  link_.watch(1.25);
  EXPECT_TRUE(link_.isUp());
  controller_.hear(link_.send(Poll(), 1.3));
  for (int k = 1; k < 20; ++k) link_.send(Poll(), 1.3 + 0.025 * k);
  receive(link_, controller_.say(), 1.7);
  EXPECT_NEAR(link_.statusAge(1.7), 0.4, 1e-9);
  link_.watch(1.7);
  EXPECT_FALSE(link_.isUp());
  EXPECT_NE(link_.reason().find("answers later"), std::string::npos) << link_.reason();
}

TEST_F(LinkTest, anEchoOfWhatWasNeverSentEndsTheSession) {
  bringUp(0.0);
  controller_.hear(link_.send(Poll(), 0.1));
  controller_.status.echo = static_cast<std::uint16_t>(link_.sequence() + 1);
  EXPECT_TRUE(receive(link_, controller_.say(), 0.12).empty());
  EXPECT_EQ(link_.state(), LinkState::kIdentifying);
  EXPECT_NE(link_.reason().find("never sent"), std::string::npos) << link_.reason();
}

TEST_F(LinkTest, anEchoOfLongAgoIsNoAnswer) {
  bringUp(0.0);
  for (int k = 0; k < 2000; ++k) link_.send(Poll(), 0.001 * k);
  receive(link_, controller_.say(), 2.0);
  EXPECT_TRUE(std::isinf(link_.statusAge(2.0)));
  link_.watch(2.0);
  EXPECT_FALSE(link_.isUp());
}

TEST_F(LinkTest, silenceLosesTheLink) {
  bringUp(0.0);
  for (int k = 1; k < 40; ++k) {
    controller_.hear(link_.send(Poll(), 0.025 * k));
    EXPECT_EQ(receive(link_, controller_.say(), 0.025 * k + 0.01).size(), 1u);
    link_.watch(0.025 * k + 0.02);
    ASSERT_TRUE(link_.isUp());
  }
  link_.watch(1.2);
  EXPECT_TRUE(link_.isUp());
  link_.watch(1.4);
  EXPECT_EQ(link_.state(), LinkState::kIdentifying);
  EXPECT_NE(link_.reason().find("no status for 0.3 s"), std::string::npos);
  EXPECT_FALSE(link_.status().has_value());
  EXPECT_TRUE(std::isinf(link_.statusAge(1.4)));
}

TEST_F(LinkTest, noStatusAfterIdentityLosesTheLinkToo) {
  bringUp(0.0);
  link_.watch(0.5);
  EXPECT_FALSE(link_.isUp());
}

TEST_F(LinkTest, restartOfTheControllerBeginsANewSession) {
  bringUp(0.0);
  controller_.status.time = 100.0;
  receive(link_, controller_.say(), 0.1);
  controller_.status.time = 1.0;
  EXPECT_TRUE(receive(link_, controller_.say(), 0.2).empty());
  EXPECT_FALSE(link_.isUp());
  EXPECT_NE(link_.reason().find("restarted"), std::string::npos);
}

TEST_F(LinkTest, aLossWithinOneReadIsTold) {
  bringUp(0.0);
  controller_.status.time = 100.0;
  Bytes read = controller_.say();
  controller_.status.time = 1.0;
  for (const Bytes& more : {controller_.say(), controller_.identity(), controller_.say()}) {
    read.insert(read.end(), more.begin(), more.end());
  }
  const std::vector<LinkEvent> events = link_.receive(read.data(), read.size(), 0.2);
  ASSERT_EQ(events.size(), 4u);
  EXPECT_TRUE(std::holds_alternative<Status>(events[0]));
  ASSERT_TRUE(std::holds_alternative<LinkLost>(events[1]));
  EXPECT_NE(std::get<LinkLost>(events[1]).reason.find("restarted"), std::string::npos);
  EXPECT_TRUE(std::holds_alternative<LinkUp>(events[2]));
  EXPECT_TRUE(std::holds_alternative<Status>(events[3]));
}

TEST_F(LinkTest, wrapOfItsClockIsNoRestart) {
  bringUp(0.0);
  controller_.status.time = 4294967.2;
  receive(link_, controller_.say(), 0.1);
  controller_.status.time = 0.1;
  EXPECT_EQ(receive(link_, controller_.say(), 0.2).size(), 1u);
  EXPECT_TRUE(link_.isUp());
}

TEST_F(LinkTest, measuresRoundTripsAndLosses) {
  bringUp(0.0);
  controller_.hear(link_.send(Poll(), 1.0));
  receive(link_, controller_.say(), 1.03);
  EXPECT_NEAR(link_.roundTrips().median, 0.03, 1e-12);
  controller_.lose();
  controller_.lose();
  controller_.hear(link_.send(Poll(), 1.1));
  receive(link_, controller_.say(), 1.11);
  EXPECT_EQ(link_.statistics().lost, 2u);
  EXPECT_NEAR(link_.roundTrips().median, 0.01, 1e-12);
  EXPECT_NEAR(link_.roundTrips().longest, 0.03, 1e-12);
  receive(link_, controller_.say(), 2.0);
  EXPECT_NEAR(link_.roundTrips().longest, 0.03, 1e-12) << "an echo that comes twice is no second answer";
}

TEST_F(LinkTest, slotsKeepTheirRhythmAndAreNotMadeUpFor) {
  bringUp(0.0);
  int sent = 0;
  for (int k = 0; k < 1000; ++k) {
    const double now = 0.1 + 0.001 * k;
    if (!link_.due(now)) continue;
    link_.send(Poll(), now);
    ++sent;
  }
  EXPECT_NEAR(sent, 40, 2);
  sent = 0;
  for (int k = 0; k < 10; ++k) {
    const double now = 10.0 + 0.001 * k;  // after nine seconds of nothing
    if (!link_.due(now)) continue;
    link_.send(Poll(), now);
    ++sent;
  }
  EXPECT_EQ(sent, 1);
}

TEST_F(LinkTest, closedHearsNothing) {
  bringUp(0.0);
  link_.closed("cable pulled");
  EXPECT_EQ(link_.state(), LinkState::kClosed);
  EXPECT_EQ(link_.reason(), "cable pulled");
  EXPECT_TRUE(receive(link_, controller_.say(), 0.1).empty());
}

}  // namespace
}  // namespace laparoscope_servo::aesop
