// A controller among one fake cart for all tests of a process: connections take longer than the tests.
#pragma once

#include "fake_cart.h"

namespace laparoscope_servo {

class ControllerFixture : public ::testing::Test {
 protected:
  static FakeCart& cart() {
    static FakeCart instance;
    return instance;
  }
  static void TearDownTestSuite() { cart().end(); }

  void SetUp() override {
    cart_.strike([](Feed& feed) { feed = Feed{}, feed.message = offTarget(); });
    ASSERT_TRUE(cart_.waitForController());
    bool success = false;
    cart_.engage(false, success);
    ASSERT_TRUE(success);
    ASSERT_TRUE(cart_.waitForState(ControllerState::IDLE));
  }

  // `error`: of the target from the start on, since one that jumps away while the scope is engaged is held by the
  // leash.
  void engageAndMove(const TaskError& error = offTarget()) {
    cart_.set([&](Feed& feed) { feed.message = error; });
    cart_.nextCommands(10);  // until the controller has it
    ASSERT_TRUE(cart_.engageWhenReady());
    ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO));
    ASSERT_TRUE(waitFor([this] { return cart_.moves(); }));
  }

  FakeCart& cart_ = cart();
};

}  // namespace laparoscope_servo
