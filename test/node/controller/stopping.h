// How long the controller takes from a cause to a command of exactly zero, as a subscriber sees it.
#pragma once

#include <algorithm>
#include <cstdio>
#include <ostream>

#include "fake_cart.h"

namespace laparoscope_servo {

// A cause does not wait for the controller's step, of `period` ms: the repetitions are spread over one.
inline void waitForAPhase(int repetition, int repetitions, int period = 20) {
  std::this_thread::sleep_for(std::chrono::milliseconds(period * repetition / repetitions));
}

// s each; a line of the table "cause, state, median, worst".
inline void printStoppingTimes(const std::string& cause, const std::string& state, std::vector<double> times) {
  std::sort(times.begin(), times.end());
  const std::size_t half = times.size() / 2;
  const double median = times.size() % 2 == 1 ? times[half] : 0.5 * (times[half - 1] + times[half]);
  std::printf("| %-52s | %-5s | %5.0f ms | %5.0f ms |\n", cause.c_str(), state.c_str(), 1e3 * median,
              1e3 * times.back());
}

struct Cause {
  const char* name;
  std::function<void(Feed&)> change;
  const char* state;  // that it leads to
  const char* words;  // in the reason
};

inline std::string indexOf(const ::testing::TestParamInfo<Cause>& info) {
  return std::to_string(info.index);
}

inline void PrintTo(const Cause& cause, std::ostream* stream) {
  *stream << cause.name;
}

// Each cause must stop the scope, again and again, and what ends the state must let it go on.
class Stopping : public ::testing::TestWithParam<Cause> {
 protected:
  static FakeCart& cart() {
    static FakeCart instance;
    return instance;
  }
  static void TearDownTestSuite() { cart().end(); }

  void move() {
    cart_.strike([](Feed& feed) { feed = Feed{}, feed.message = offTarget(); });
    if (!cart_.state().engaged) {
      ASSERT_TRUE(cart_.engageWhenReady());
    }
    ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO)) << cart_.state().reason;
    ASSERT_TRUE(waitFor([this] { return cart_.moves(); }));
  }

  void expectStop(const std::function<double()>& cause, std::vector<double>& times) {
    const double time = cause();
    ASSERT_TRUE(cart_.waitForState(GetParam().state)) << cart_.state().state << ": " << cart_.state().reason;
    EXPECT_NE(cart_.state().reason.find(GetParam().words), std::string::npos) << cart_.state().reason;
    EXPECT_TRUE(waitFor([&] { return cart_.stoodAt() > time; })) << "stood before there was a cause";
    for (const ScopeVelocity& command : cart_.nextCommands(3)) EXPECT_TRUE(isZero(command));
    times.push_back(cart_.stoodAt() - time);
    if (cart_.state().state == ControllerState::FAULT) expectOnlyDisengagingLeadsOn();
  }

  void expectOnlyDisengagingLeadsOn() {
    cart_.strike([](Feed& feed) { feed = Feed{}, feed.message = offTarget(); });
    bool success = true;
    EXPECT_NE(cart_.engage(true, success).find("disengage"), std::string::npos);
    EXPECT_FALSE(success);
    EXPECT_EQ(cart_.state().state, ControllerState::FAULT);
    cart_.engage(false, success);
    EXPECT_TRUE(success);
    ASSERT_TRUE(cart_.waitForState(ControllerState::IDLE));
  }

  void measure(int repetitions, const std::function<double()>& cause) {
    ASSERT_TRUE(cart_.waitForController());
    std::vector<double> times;
    for (int k = 0; k < repetitions; ++k) {
      ASSERT_NO_FATAL_FAILURE(move());
      waitForAPhase(k, repetitions);
      ASSERT_NO_FATAL_FAILURE(expectStop(cause, times));
    }
    printStoppingTimes(GetParam().name, GetParam().state, times);
  }

  FakeCart& cart_ = cart();
};

}  // namespace laparoscope_servo
