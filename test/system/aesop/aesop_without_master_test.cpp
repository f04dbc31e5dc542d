// The ROS master dies, hangs or is another one while the arm moves: how far it still goes, and what is said. Not a
// rostest: the master is the test's own.
#include <gtest/gtest.h>
#include <std_msgs/Empty.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <iostream>
#include <sstream>

#include "support/own_master.h"
#include "system/aesop/aesop_bench.h"

namespace laparoscope_servo::test {
namespace {

// The controller's limits, and the bounds for what may follow the event: config/controller.yaml.
constexpr double kPan = 0.1;         // rad/s
constexpr double kInsertion = 0.02;  // m/s
constexpr double kDegree = 0.017453292519943295;

test_support::OwnMaster* own_master = nullptr;

bool mentions(const std::string& text, const std::string& what) {
  return text.find(what) != std::string::npos;
}

std::string contents(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

class AesopWithoutMaster : public ::testing::Test {
 protected:
  AesopWithoutMaster() : bench_(false), output_(bench_.file("output")) {
    stop_ = node_.advertise<std_msgs::Empty>("aesop/stop", 1);
    bench_.startNode(AESOP_NODE, {}, output_);
  }
  // A master for those who say goodbye, and for the next test.
  ~AesopWithoutMaster() override {
    own_master->kill(SIGCONT);
    own_master->end();
    own_master->start();
  }

  void command() {
    if (steadyNow() < next_) return;
    next_ = steadyNow() + 0.02;
    ScopeVelocity velocity;
    velocity.pan = pan_;
    velocity.insertion = insertion_;
    bench_.send(velocity);
  }
  bool until(const std::function<bool()>& condition, double seconds = 20.0) {
    return bench_.waitFor(
        [&] {
          command();
          return condition();
        },
        seconds);
  }
  void move(double pan, double insertion) {
    pan_ = pan;
    insertion_ = insertion;
    ASSERT_TRUE(bench_.enable());
    const double start = steadyNow();
    ASSERT_TRUE(until([&] { return steadyNow() - start > 0.6; }));
    ASSERT_TRUE(bench_.jointsMove());
    before_ = bench_.truth().state().q;
    began_ = steadyNow();
  }
  // Until the joints stand, while commands go on; prints how far they have gone since move().
  void expectStandStill(const std::string& event) {
    ASSERT_TRUE(until([&] { return !bench_.jointsMove(); }));
    const double time = steadyNow() - began_;
    const aesop::JointVector moved = (bench_.truth().state().q - before_).cwiseAbs();
    const double angle = moved.tail<6>().maxCoeff() / kDegree;
    std::cout << event << ": stands after " << time << " s, joints moved by up to " << angle << " deg and "
              << 1000.0 * moved[0] << " mm" << std::endl;
    EXPECT_EQ(bench_.motionWithin(0.5, [&] { command(); }), 0.0);
  }

  ros::NodeHandle node_;
  AesopBench bench_;
  std::string output_;
  ros::Publisher stop_;
  double pan_ = 0.0;
  double insertion_ = 0.0;
  double next_ = 0.0;
  aesop::JointVector before_;
  double began_ = 0.0;
};

TEST_F(AesopWithoutMaster, killedWhileTheScopePans) {
  move(kPan, 0.0);
  own_master->kill(SIGKILL);
  expectStandStill("master killed, pan at 0.1 rad/s");
  ASSERT_TRUE(until([&] { return bench_.stateIs("PAUSED"); })) << "over connections that are open";
  EXPECT_TRUE(mentions(bench_.state_->reason, "is gone")) << bench_.state_->reason;
  EXPECT_TRUE(mentions(contents(output_), "is gone")) << contents(output_);
  EXPECT_TRUE(until([&] {
    return bench_.diagnostics_ && bench_.diagnostics_->level == diagnostic_msgs::DiagnosticStatus::ERROR &&
           mentions(bench_.diagnostics_->message, "is gone");
  }));
  EXPECT_TRUE(bench_.node().isRunning()) << "the same master may come back";
  stop_.publish(std_msgs::Empty());
  EXPECT_TRUE(until([&] { return bench_.stateIs("DISABLED"); })) << "a stop needs no master";
  EXPECT_TRUE(mentions(bench_.state_->reason, "stopped by " + ros::this_node::getName())) << bench_.state_->reason;
}

TEST_F(AesopWithoutMaster, killedWhileTheScopeGoesDeeper) {
  move(0.0, kInsertion);
  own_master->kill(SIGKILL);
  expectStandStill("master killed, insertion at 20 mm/s");
  ASSERT_TRUE(until([&] { return bench_.stateIs("PAUSED"); }));
  bench_.node().kill(SIGUSR1);
  EXPECT_TRUE(until([&] { return bench_.stateIs("DISABLED"); })) << "a signal needs no master";
  EXPECT_TRUE(mentions(bench_.state_->reason, "SIGUSR1")) << bench_.state_->reason;
  EXPECT_TRUE(bench_.node().isRunning());
}

TEST_F(AesopWithoutMaster, anotherOneOnTheSamePortEndsTheNode) {
  move(kPan, 0.0);
  own_master->end();
  own_master->start();
  expectStandStill("master killed, another one started");
  EXPECT_EQ(bench_.node().exitStatus(20.0), 1) << "for respawn to start it anew";
  EXPECT_EQ(bench_.truth().motion().state, "DISABLED");
  const std::string said = contents(output_);
  EXPECT_TRUE(mentions(said, "is another one") || mentions(said, "does not know this node")) << said;
}

TEST_F(AesopWithoutMaster, onlyStoppedItPausesAndResumesOnRequest) {
  move(kPan, 0.0);
  own_master->kill(SIGSTOP);
  expectStandStill("master stopped (SIGSTOP), pan at 0.1 rad/s");
  ASSERT_TRUE(until([&] { return bench_.stateIs("PAUSED"); }));
  EXPECT_TRUE(mentions(bench_.state_->reason, "has not answered for")) << bench_.state_->reason;
  own_master->kill(SIGCONT);
  ASSERT_TRUE(until([&] { return mentions(contents(output_), "answers again"); })) << contents(output_);
  EXPECT_TRUE(bench_.stateIs("PAUSED")) << "it does not go on by itself";
  EXPECT_EQ(bench_.motionWithin(0.5, [&] { command(); }), 0.0);
  EXPECT_TRUE(bench_.call("resume").success);
  EXPECT_TRUE(until([&] { return bench_.jointsMove(); }));
}

TEST_F(AesopWithoutMaster, stoppedWhileTheScopeGoesDeeper) {
  move(0.0, kInsertion);
  own_master->kill(SIGSTOP);
  expectStandStill("master stopped (SIGSTOP), insertion at 20 mm/s");
  EXPECT_TRUE(until([&] { return bench_.stateIs("PAUSED"); }));
}

// It says goodbye to the master, but does not wait for one that hangs.
TEST_F(AesopWithoutMaster, theNodeEndsThoughTheMasterHangs) {
  move(kPan, 0.0);
  own_master->kill(SIGSTOP);
  bench_.node().kill(SIGTERM);
  EXPECT_EQ(bench_.node().exitStatus(20.0), 0);
  EXPECT_EQ(bench_.truth().motion().state, "DISABLED");
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  laparoscope_servo::test_support::OwnMaster master;
  laparoscope_servo::test::own_master = &master;
  return laparoscope_servo::test::runBenchTests(argc, argv, "aesop_without_master_test");
}
