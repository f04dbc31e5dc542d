// STOP when the master has died: over connections that are open already. No rostest, for the master is the test's own.
#include <laparoscope_servo/OperatingState.h>
#include <std_msgs/Empty.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "support/own_master.h"
#include "support/temporary_folder.h"
#include "system/screen/screen_fixture.h"

namespace laparoscope_servo {
namespace {

// Another process: within one, messages do not go over a connection. Says `c` when both topics are connected, and a
// letter for each stop.
int listen(int argc, char** argv) {
  ros::init(argc, argv, "listener");
  ros::NodeHandle node;
  const auto say = [](char letter) {
    std::putchar(letter);
    std::fflush(stdout);
  };
  const ros::Subscriber robot =
      node.subscribe<std_msgs::Empty>("aesop/stop", 10, [&](const std_msgs::EmptyConstPtr&) { say('r'); });
  const ros::Subscriber controller =
      node.subscribe<std_msgs::Empty>("controller/stop", 10, [&](const std_msgs::EmptyConstPtr&) { say('k'); });
  ros::Publisher state = node.advertise<OperatingState>("aesop/operating_state", 1, true);
  OperatingState disabled;
  disabled.state = "DISABLED";
  state.publish(disabled);
  for (bool told = false; ros::ok(); ros::spinOnce()) {
    if (!told && robot.getNumPublishers() > 0 && controller.getNumPublishers() > 0) say('c');
    told = told || (robot.getNumPublishers() > 0 && controller.getNumPublishers() > 0);
    ros::WallDuration(0.01).sleep();
  }
  return 0;
}

std::string textOf(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

class ScreenMaster : public test_support::ScreenFixture {
 public:
  static test_support::OwnMaster* master;
  static std::string program;
};

test_support::OwnMaster* ScreenMaster::master = nullptr;
std::string ScreenMaster::program;

TEST_F(ScreenMaster, StopsWithoutIt) {
  const test_support::TemporaryFolder folder;
  const std::string said = folder.file("said");
  test::ChildProcess listener(program, {"--listen"}, said);
  const auto hears = [&](char letter) { return textOf(said).find(letter) != std::string::npos; };
  show({1280, 800});
  ASSERT_TRUE(test_support::waitFor([&] { return hears('c'); }));
  EXPECT_TRUE(test_support::waitFor([this] { return word("Robot") == "DISABLED"; }));
  master->end();
  click("stop");
  EXPECT_TRUE(test_support::waitFor([&] { return hears('r') && hears('k'); })) << textOf(said);
}

TEST_F(ScreenMaster, KnowsTheScreenAgainWhenItWasStartedAnew) {
  master->start();
  show({1280, 800});
  const auto knows = [this] { return find<QLabel>("answer").text().contains("knows this screen again"); };
  // A new one, and nodes that come after it.
  master->end();
  master->start();
  ASSERT_TRUE(test_support::waitFor(knows)) << find<QLabel>("answer").text().toStdString();
  const test_support::TemporaryFolder folder;
  const std::string said = folder.file("said");
  test::ChildProcess listener(program, {"--listen"}, said);
  const auto hears = [&](char letter) { return textOf(said).find(letter) != std::string::npos; };
  ASSERT_TRUE(test_support::waitFor([&] { return hears('c'); })) << "they find its STOP";
  click("stop");
  EXPECT_TRUE(test_support::waitFor([&] { return hears('r') && hears('k'); })) << textOf(said);
  EXPECT_TRUE(test_support::waitFor([this] { return word("Robot") == "DISABLED"; })) << "and it hears them";
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  using laparoscope_servo::ScreenMaster;
  if (argc > 1 && std::string(argv[1]) == "--listen") return laparoscope_servo::listen(argc, argv);
  laparoscope_servo::test_support::OwnMaster master;
  ScreenMaster::master = &master;
  ScreenMaster::program = argv[0];
  return laparoscope_servo::test_support::runScreenTests(argc, argv, "screen_master_test");
}
