#include "laparoscope_servo/ros/command_master.h"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <boost/weak_ptr.hpp>

namespace laparoscope_servo::skin {
namespace {

using Verdict = CommandMaster::Verdict;

CommandMaster::Connection connection() {
  return boost::make_shared<int>(0);
}

TEST(CommandMaster, takesTheNamedPublisherAndNobodyElse) {
  CommandMaster master("/controller");
  const auto own = connection();
  EXPECT_EQ(master.judge("/controller", own, 0.0), Verdict::kMaster);
  for (const char* name : {"/other", "controller", "/controller2", "/ns/controller", "/CONTROLLER", ""}) {
    EXPECT_EQ(master.judge(name, connection(), 0.0), Verdict::kStranger) << name;
  }
  EXPECT_EQ(master.judge("/controller", own, 0.0), Verdict::kMaster) << "a stranger takes nothing away from the master";
  EXPECT_EQ(master.refused(), 6u);
}

TEST(CommandMaster, aStrangerBindsNothing) {
  CommandMaster master("/controller");
  const auto shared = connection();
  EXPECT_EQ(master.judge("/other", shared, 0.0), Verdict::kStranger);
  EXPECT_EQ(master.judge("/controller", connection(), 0.0), Verdict::kMaster);
}

TEST(CommandMaster, anotherConnectionOfTheSameNameIsNotTrustedUntilReleased) {
  CommandMaster master("/controller");
  const auto first = connection();
  const auto second = connection();
  EXPECT_EQ(master.judge("/controller", first, 0.0), Verdict::kMaster);
  EXPECT_EQ(master.judge("/controller", second, 0.1), Verdict::kNewConnection);
  EXPECT_EQ(master.judge("/controller", second, 0.2), Verdict::kNewConnection) << "insisting does not help";
  EXPECT_EQ(master.judge("/controller", first, 0.3), Verdict::kMaster);
  EXPECT_EQ(master.refused(), 2u);
  master.release();
  EXPECT_EQ(master.judge("/controller", second, 0.4), Verdict::kMaster);
  EXPECT_EQ(master.judge("/controller", first, 0.5), Verdict::kNewConnection);
}

// Whoever frees the memory of a connection and gets the same address again must not be taken for the old one.
TEST(CommandMaster, keepsTheConnectionThatCounts) {
  CommandMaster master("/controller");
  auto own = connection();
  const boost::weak_ptr<const void> watched = own;
  master.judge("/controller", own, 0.0);
  own.reset();
  EXPECT_FALSE(watched.expired());
  master.release();
  EXPECT_TRUE(watched.expired());
}

TEST(CommandMaster, complainsAboutAStrangerForAWhile) {
  CommandMaster master("/controller");
  EXPECT_EQ(master.complaint(0.0), "");
  master.judge("/controller", connection(), 0.0);
  EXPECT_EQ(master.complaint(0.0), "");
  master.judge("/other", connection(), 10.0);
  EXPECT_NE(master.complaint(11.0).find("/other"), std::string::npos) << master.complaint(11.0);
  EXPECT_NE(master.complaint(11.0).find("/controller"), std::string::npos);
  EXPECT_EQ(master.complaint(20.0), "");
}

TEST(CommandMaster, namesFromTheNetworkAreNotShownAsTheyAre) {
  EXPECT_EQ(shownName("/rostopic_1234_5678"), "/rostopic_1234_5678");
  for (const std::string& name : {std::string(), std::string("/a\n[ERROR] all is well"), std::string("/\x1b[2J"),
                                  "/" + std::string(100000, 'a'), std::string("/a\0b", 4)}) {
    EXPECT_LT(shownName(name).size(), 30u);
    EXPECT_EQ(shownName(name).find_first_of("\n\x1b"), std::string::npos);
  }
}

}  // namespace
}  // namespace laparoscope_servo::skin
