#include "screen/newest_call.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <stdexcept>
#include <thread>
#include <vector>

namespace laparoscope_servo::screen {
namespace {

bool waitFor(const std::function<bool()>& condition) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!condition() && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return condition();
}

TEST(NewestCall, AsksTheNewestOfThoseThatWait) {
  NewestCall call;
  std::promise<void> gate;
  std::shared_future<void> open(gate.get_future());
  std::atomic<int> asked{0}, newest{-1};
  for (int k = 0; k < 5; ++k) {
    call.ask([&, k]() -> std::function<void()> {
      ++asked;
      open.wait();
      return [&, k] { newest = k; };
    });
    ASSERT_TRUE(waitFor([&] { return asked == 1; }));
  }
  gate.set_value();
  EXPECT_TRUE(waitFor([&] { return newest == 4; }));
  EXPECT_EQ(asked, 2) << "those between are dropped";
}

TEST(NewestCall, GoesOnAfterAQuestionThatThrows) {
  NewestCall call;
  std::atomic<int> asked{0};
  call.ask([&]() -> std::function<void()> {
    ++asked;
    throw std::runtime_error("no answer");
  });
  ASSERT_TRUE(waitFor([&] { return asked == 1; }));
  std::atomic<bool> done{false};
  call.ask([&]() -> std::function<void()> { return [&] { done = true; }; });
  EXPECT_TRUE(waitFor([&] { return done.load(); }));
}

TEST(NewestCall, OneThatHangsIsLeftToItself) {
  auto released = std::make_shared<std::promise<void>>();
  std::shared_future<void> open(released->get_future());
  auto acted = std::make_shared<std::atomic<bool>>(false);
  auto over = std::make_shared<std::atomic<bool>>(false);
  {
    NewestCall call;
    call.ask([open, acted, over]() -> std::function<void()> {
      open.wait();
      *over = true;
      return [acted] { *acted = true; };
    });
  }
  released->set_value();
  EXPECT_TRUE(waitFor([&] { return over->load(); }));
  EXPECT_FALSE(*acted) << "nobody is there to act";
}

}  // namespace
}  // namespace laparoscope_servo::screen
