// The ROS master dies, hangs or is another one while the whole cart follows the region. Not a rostest: the master is
// the test's own.
#include <gtest/gtest.h>

#include <cstdio>

#include "fault_cart.h"
#include "support/own_master.h"

namespace laparoscope_servo::test {
namespace {

// Allowed after the master has gone.
constexpr double kDegrees = 8.0;
constexpr double kMillimetres = 14.0;
constexpr double kCalm = 0.6;      // s of rest that are taken for standing: longer than the arm's delay
constexpr double kWatched = 10.0;  // s

test_support::OwnMaster* own_master = nullptr;

class CartMaster : public testing::Test {
 protected:
  // A master for those who say goodbye, and for the next test.
  ~CartMaster() override {
    own_master->kill(SIGCONT);
    own_master->end();
    own_master->start();
  }

  void expectStandStill(const std::string& event) {
    const Reaction r = cart_.watch(kWatched, kCalm);
    std::printf("| master %-20s | SERVO | %5.2f deg | %5.2f mm | tip %5.2f mm | %5.2f s | %s: %s; robot %s\n",
                event.c_str(), r.travel.degrees, r.travel.millimetres, r.travel.tip, r.stood, r.state.c_str(),
                r.reason.c_str(), r.robot.c_str());
    EXPECT_LT(r.stood, kWatched - kCalm) << "it goes on";
    EXPECT_LE(r.travel.degrees, kDegrees);
    EXPECT_LE(r.travel.millimetres, kMillimetres);
  }

  FaultCart cart_;
};

TEST_F(CartMaster, Killed) {
  ASSERT_EQ(cart_.bringTo(Situation::kServo), "");
  cart_.mark();
  own_master->kill(SIGKILL);
  expectStandStill("killed");
  EXPECT_TRUE(cart_.bench.waitFor([&] { return cart_.bench.stateIs("PAUSED") && cart_.stateIs("IDLE"); }))
      << cart_.bench.state_->state << ", " << cart_.state();
  EXPECT_EQ(cart_.bench.motionWithin(1.0), 0.0);
}

TEST_F(CartMaster, StoppedAndContinued) {
  ASSERT_EQ(cart_.bringTo(Situation::kServo), "");
  cart_.mark();
  own_master->kill(SIGSTOP);
  expectStandStill("stopped");
  EXPECT_TRUE(cart_.bench.waitFor([&] { return cart_.bench.stateIs("PAUSED") && cart_.stateIs("IDLE"); }))
      << cart_.bench.state_->state << ", " << cart_.state();
  own_master->kill(SIGCONT);
  EXPECT_EQ(cart_.bench.motionWithin(1.0), 0.0) << "it goes on by itself";
  ASSERT_TRUE(cart_.bench.waitFor([&] { return cart_.robot("resume").empty(); }));
  cart_.operating.press(false);
  ASSERT_TRUE(cart_.bench.waitFor([&] { return cart_.engage(true).empty(); }, 10.0));
  ASSERT_TRUE(cart_.bench.waitFor([&] { return cart_.stateIs("ARMED"); }));
  const int told = cart_.operating.told();
  cart_.bench.waitFor([&] { return cart_.operating.told() > told + 2; });  // it counts once it was seen released
  cart_.operating.press(true);
  EXPECT_TRUE(cart_.bench.waitFor([&] { return cart_.bench.jointsMove(); })) << cart_.reason();
}

TEST_F(CartMaster, AnotherInItsPlace) {
  ASSERT_EQ(cart_.bringTo(Situation::kServo), "");
  cart_.mark();
  own_master->end();
  own_master->start();
  expectStandStill("replaced");
  EXPECT_EQ(cart_.bench.node().exitStatus(20.0), 1) << "for respawn to start it anew";
  EXPECT_EQ(cart_.controller->exitStatus(20.0), 1);
  EXPECT_EQ(cart_.bench.truth().motion().state, "DISABLED");
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  laparoscope_servo::test_support::OwnMaster master;
  laparoscope_servo::test::own_master = &master;
  return laparoscope_servo::test::runBenchTests(argc, argv, "cart_master_test");
}
