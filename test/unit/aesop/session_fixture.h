// A session and the controller at its far end, a slot of the line at a time.
#pragma once

#include <gtest/gtest.h>

#include <optional>

#include "fake_controller.h"
#include "laparoscope_servo/aesop/session.h"

namespace laparoscope_servo::aesop {

using Speed = std::array<double, kDrivenJoints>;
constexpr Speed kStand{};
constexpr Speed kMove{0.01, 0.0, 0.0, 0.0};

class SessionTest : public ::testing::Test {
 protected:
  // One slot of the line: what the session sends, and the controller's answer when it gives one. Returns the last
  // request.
  std::optional<Message> exchange(const Speed& speed, bool answer = true) {
    now_ += 0.026;
    const std::vector<Message> requests = controller_.hear(session_.transmit(speed, now_));
    if (requests.empty()) return std::nullopt;
    if (std::holds_alternative<Identify>(requests.back())) controller_.status.state = RobotState::kDisabled;
    if (answer) {
      const Bytes reply =
          std::holds_alternative<Identify>(requests.back()) ? controller_.identity() : controller_.say();
      session_.receive(reply.data(), reply.size(), now_ + 0.01);
    }
    return requests.back();
  }
  template <typename T>
  bool sends(const Speed& speed = kStand, bool answer = true) {
    const std::optional<Message> request = exchange(speed, answer);
    return request && std::holds_alternative<T>(*request);
  }
  void connect() {
    session_.opened(now_);
    ASSERT_TRUE(sends<Identify>());
    ASSERT_TRUE(sends<Poll>());
    ASSERT_TRUE(session_.link().isUp());
  }
  void enable() {
    ASSERT_EQ(session_.enable(now_), "");
    ASSERT_TRUE(sends<Enable>(kStand, false));
    controller_.status.state = RobotState::kEnabled;
    ASSERT_TRUE(sends<Enable>());
    ASSERT_TRUE(session_.isEnabled());
  }
  OperatingMode mode() const { return session_.state().mode; }

  double now_ = 0.0;
  Session session_{SessionConfig(), kDrivenMask};
  FakeController controller_;
};

}  // namespace laparoscope_servo::aesop
