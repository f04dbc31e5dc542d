#include "ros/common/name_turn.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <stdexcept>

namespace laparoscope_servo {
namespace {

constexpr double kLong = 60.0;  // s

TEST(NameTurn, IsGivenAtOnceWhereNobodyHasTheName) {
  NameTurn tracker;
  NameTurn camera;
  tracker.take("/tracker", 0.0);
  camera.take("/camera", 0.0);
  EXPECT_THROW(camera.take("/other", 0.0), std::logic_error);
}

TEST(NameTurn, RefusesByNameWhatIsNotGivenBack) {
  NameTurn first;
  first.take("/tracker", 0.0);
  NameTurn second;
  try {
    second.take("/tracker", 0.01);
    FAIL() << "taken twice";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()), "another /tracker of this process has not ended within 0.01 s");
  }
}

TEST(NameTurn, WaitsForTheEndOfTheOneBefore) {
  auto first = std::make_unique<NameTurn>();
  first->take("/tracker", 0.0);
  std::atomic<bool> has_ended{false};
  std::future<bool> ended_before = std::async(std::launch::async, [&] {
    NameTurn second;
    second.take("/tracker", kLong);
    return has_ended.load();
  });
  // Not a wait for a condition: a turn that comes too early has a moment to show it.
  EXPECT_EQ(ended_before.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
  has_ended = true;
  first.reset();
  EXPECT_TRUE(ended_before.get());
}

TEST(NameTurn, OneThatWasRefusedTakesNothingAway) {
  NameTurn first;
  first.take("/tracker", 0.0);
  {
    NameTurn refused;
    EXPECT_THROW(refused.take("/tracker", 0.0), std::runtime_error);
  }
  NameTurn third;
  EXPECT_THROW(third.take("/tracker", 0.0), std::runtime_error);
}

}  // namespace
}  // namespace laparoscope_servo
