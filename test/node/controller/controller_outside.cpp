// What ends an engagement from outside of ROS: a signal, a stop line, the end of the ROS master; and a terminal that
// nobody reads, which must not. Not a rostest: the master is the test's own.
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <iostream>
#include <sstream>

#include "fake_cart.h"
#include "support/own_master.h"
#include "support/temporary_folder.h"
#include "system/aesop/child_process.h"

namespace laparoscope_servo {
namespace {

using test::ChildProcess;

test_support::OwnMaster* own_master = nullptr;

class ControllerOutside : public ::testing::Test {
 protected:
  ~ControllerOutside() override { own_master->start(); }  // for the next, and for those who say goodbye

  void start(const std::vector<std::string>& arguments = {}, const std::string& output = "") {
    // The fake cart is this node, and what it shows does not move with the scope.
    std::vector<std::string> all{"_owners/task_error:=controller_outside",
                                 "_owners/operating_state:=controller_outside", "_owners/tf:=controller_outside",
                                 "_safety/max_tip_speed:=1000.0", "_effect/enabled:=false"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    controller_ = std::make_unique<ChildProcess>(CONTROLLER, all, output);
    ASSERT_TRUE(cart_.waitForController(30.0));
  }
  void engageAndMove() {
    ASSERT_TRUE(cart_.engageWhenReady(20.0)) << cart_.answer();
    ASSERT_TRUE(waitFor([&] { return cart_.moves(); }, 20.0));
  }
  void expectEnded(const std::string& why) {
    ASSERT_TRUE(cart_.waitForState(ControllerState::IDLE, 20.0)) << cart_.state().state;
    EXPECT_NE(cart_.state().reason.find(why), std::string::npos) << cart_.state().reason;
    EXPECT_TRUE(cart_.stands());
  }

  FakeCart cart_;
  std::unique_ptr<ChildProcess> controller_;
};

TEST_F(ControllerOutside, aSignalDisengages) {
  start();
  engageAndMove();
  controller_->kill(SIGUSR1);
  expectEnded("SIGUSR1");
  engageAndMove();
  EXPECT_TRUE(controller_->isRunning());
}

// Whatever stops it when it goes on, that it was paused is said: nobody knows what the arm has done in between.
TEST_F(ControllerOutside, aStopAfterAPauseOfTheProcessLeavesTheFault) {
  start();
  engageAndMove();
  controller_->kill(SIGSTOP);
  std::this_thread::sleep_for(std::chrono::milliseconds(1200));  // over 1 s (safety/max_clock_step)
  controller_->kill(SIGUSR1);
  controller_->kill(SIGCONT);
  EXPECT_TRUE(cart_.waitForState(ControllerState::FAULT)) << cart_.state().state << ": " << cart_.state().reason;
  EXPECT_NE(cart_.state().reason.find("steady clock jumped"), std::string::npos) << cart_.state().reason;
  EXPECT_TRUE(cart_.stands());
}

TEST_F(ControllerOutside, theStopLineDisengagesAndKeepsFromEngaging) {
  const test_support::TemporaryFolder folder;
  const std::string line = folder.file("line");
  std::ofstream(line) << "1\n";
  start({"_stop_line/path:=" + line, "_stop_line/patience:=5.0"});
  engageAndMove();
  std::ofstream(line) << "0\n";
  expectEnded("says stop");
  bool success = true;
  EXPECT_NE(cart_.engage(true, success).find("says stop"), std::string::npos) << cart_.answer();
  EXPECT_FALSE(success);
  std::ofstream(line) << "1\n";
  EXPECT_TRUE(cart_.stands()) << "it does not go on by itself";
  engageAndMove();
}

// Each engagement is two lines of the log; together they are far more than the pipe holds.
TEST_F(ControllerOutside, aTerminalThatNobodyReadsHoldsNothingUp) {
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  ASSERT_GT(::fcntl(ends[1], F_SETPIPE_SZ, 4096), 0);
  start({}, "/proc/self/fd/" + std::to_string(ends[1]));
  engageAndMove();
  for (int k = 0; k < 60; ++k) {
    bool success = false;
    cart_.engage(false, success);
    ASSERT_TRUE(cart_.engageWhenReady(20.0)) << cart_.answer();
  }
  EXPECT_TRUE(waitFor([&] { return cart_.moves(); }, 20.0));
  controller_->kill(SIGTERM);
  EXPECT_EQ(controller_->exitStatus(20.0), 0);
  for (const int end : ends) ::close(end);
}

// A socket of this test that listens to other machines.
class OpenSocket {
 public:
  OpenSocket() : file_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in name{};
    name.sin_family = AF_INET;
    socklen_t size = sizeof(name);
    ::bind(file_, reinterpret_cast<const sockaddr*>(&name), size);
    ::listen(file_, 1);
    ::getsockname(file_, reinterpret_cast<sockaddr*>(&name), &size);
    port_ = ntohs(name.sin_port);
  }
  ~OpenSocket() { ::close(file_); }
  OpenSocket(const OpenSocket&) = delete;
  OpenSocket& operator=(const OpenSocket&) = delete;
  std::string words() const { return "0.0.0.0 port " + std::to_string(port_); }

 private:
  int file_;
  int port_ = 0;
};

// As in a shell that has not sourced this workspace: nobody has told it which address to listen on, so it listens on
// all. The sockets that it names are its own.
TEST_F(ControllerOutside, whoListensToOtherMachinesUnaskedSaysSo) {
  const test_support::TemporaryFolder folder;
  const OpenSocket of_this_test;
  const auto said = [&] {
    std::ostringstream text;
    text << std::ifstream(folder.file("output")).rdbuf();
    return text.str();
  };
  controller_ = std::make_unique<ChildProcess>(
      "/usr/bin/env", std::vector<std::string>{"-u", "ROS_HOSTNAME", "-u", "ROS_IP", CONTROLLER},
      folder.file("output"));
  EXPECT_TRUE(waitFor([&] { return said().find("listens to other machines") != std::string::npos; }, 30.0)) << said();
  EXPECT_EQ(said().find(of_this_test.words()), std::string::npos) << said();
}

TEST_F(ControllerOutside, itStandsWithoutAMasterAndEndsWhenThereIsAnother) {
  start();
  engageAndMove();
  const double killed = steadyNow();
  own_master->end();
  expectEnded("is gone");
  std::cout << "master killed: first command of zero after " << cart_.stoodAt() - killed << " s" << std::endl;
  EXPECT_TRUE(controller_->isRunning()) << "the same master may come back";
  own_master->start();
  EXPECT_EQ(controller_->exitStatus(20.0), 1);
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  laparoscope_servo::test_support::OwnMaster master;
  laparoscope_servo::own_master = &master;
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_outside");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
