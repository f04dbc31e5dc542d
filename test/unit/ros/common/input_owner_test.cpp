#include "ros/common/input_owner.h"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <boost/weak_ptr.hpp>

namespace laparoscope_servo {
namespace {

using Verdict = InputOwner::Verdict;

InputOwner::Connection connection() {
  return boost::make_shared<int>(0);
}

TEST(InputOwner, takesTheNamedPublisherAndNobodyElse) {
  InputOwner master("/controller", "commands", "command/publisher");
  const auto own = connection();
  EXPECT_EQ(master.judge("/controller", own, 0.0), Verdict::kOwner);
  for (const char* name : {"/other", "controller", "/controller2", "/ns/controller", "/CONTROLLER", ""}) {
    EXPECT_EQ(master.judge(name, connection(), 0.0), Verdict::kStranger) << name;
  }
  EXPECT_EQ(master.judge("/controller", own, 0.0), Verdict::kOwner) << "a stranger takes nothing away from the master";
  EXPECT_EQ(master.refused(), 6u);
}

TEST(InputOwner, aStrangerBindsNothing) {
  InputOwner master("/controller", "commands", "command/publisher");
  const auto shared = connection();
  EXPECT_EQ(master.judge("/other", shared, 0.0), Verdict::kStranger);
  EXPECT_EQ(master.judge("/controller", connection(), 0.0), Verdict::kOwner);
}

TEST(InputOwner, anotherConnectionOfTheSameNameIsNotTrustedUntilReleased) {
  InputOwner master("/controller", "commands", "command/publisher");
  const auto first = connection();
  const auto second = connection();
  EXPECT_EQ(master.judge("/controller", first, 0.0), Verdict::kOwner);
  EXPECT_EQ(master.judge("/controller", second, 0.1), Verdict::kNewConnection);
  EXPECT_EQ(master.judge("/controller", second, 0.2), Verdict::kNewConnection) << "insisting does not help";
  EXPECT_EQ(master.judge("/controller", first, 0.3), Verdict::kOwner);
  EXPECT_EQ(master.refused(), 2u);
  master.release();
  EXPECT_EQ(master.judge("/controller", second, 0.4), Verdict::kOwner);
  EXPECT_EQ(master.judge("/controller", first, 0.5), Verdict::kNewConnection);
}

// Whoever frees the memory of a connection and gets the same address again must not be taken for the old one.
TEST(InputOwner, keepsTheConnectionThatCounts) {
  InputOwner master("/controller", "commands", "command/publisher");
  auto own = connection();
  const boost::weak_ptr<const void> watched = own;
  master.judge("/controller", own, 0.0);
  own.reset();
  EXPECT_FALSE(watched.expired());
  master.release();
  EXPECT_TRUE(watched.expired());
}

TEST(InputOwner, complainsAboutAStrangerForAWhile) {
  InputOwner master("/controller", "commands", "command/publisher");
  EXPECT_EQ(master.complaint(0.0), "");
  master.judge("/controller", connection(), 0.0);
  EXPECT_EQ(master.complaint(0.0), "");
  master.judge("/other", connection(), 10.0);
  EXPECT_NE(master.complaint(11.0).find("/other"), std::string::npos) << master.complaint(11.0);
  EXPECT_NE(master.complaint(11.0).find("/controller"), std::string::npos);
  EXPECT_EQ(master.complaint(20.0), "");
}

TEST(InputOwner, withoutANameWhoeverSpeaksFirstIsTheOwner) {
  InputOwner owner("", "manual commands", "owners/manual");
  const auto first = connection();
  EXPECT_EQ(owner.judge("/joy", first, 0.0), Verdict::kOwner);
  EXPECT_EQ(owner.judge("/sliders", connection(), 0.1), Verdict::kStranger);
  EXPECT_EQ(owner.judge("/joy", connection(), 0.2), Verdict::kNewConnection);
  EXPECT_EQ(owner.judge("/joy", first, 0.3), Verdict::kOwner);
  EXPECT_EQ(owner.refused(), 2u);
  EXPECT_NE(owner.complaint(1.0).find("/sliders"), std::string::npos) << owner.complaint(1.0);
  EXPECT_NE(owner.complaint(1.0).find("/joy"), std::string::npos) << owner.complaint(1.0);
  owner.release();
  EXPECT_EQ(owner.judge("/sliders", connection(), 0.4), Verdict::kOwner);
  EXPECT_EQ(owner.judge("/joy", first, 0.5), Verdict::kStranger);
}

TEST(InputOwner, namesFromTheNetworkAreNotShownAsTheyAre) {
  EXPECT_EQ(shownName("/rostopic_1234_5678"), "/rostopic_1234_5678");
  for (const std::string& name : {std::string(), std::string("/a\n[ERROR] all is well"), std::string("/\x1b[2J"),
                                  "/" + std::string(100000, 'a'), std::string("/a\0b", 4)}) {
    EXPECT_LT(shownName(name).size(), 30u);
    EXPECT_EQ(shownName(name).find_first_of("\n\x1b"), std::string::npos);
  }
}

}  // namespace
}  // namespace laparoscope_servo
