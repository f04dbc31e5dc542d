#include "ros/common/image_request.h"

#include <gtest/gtest.h>

#include <future>
#include <stdexcept>
#include <thread>

namespace laparoscope_servo {
namespace {

struct TheAnswer {
  bool success = false;
  std::string message;
};
using Request = ImageRequest<double, TheAnswer>;

constexpr double kQuestion = 30.0;

// As the image callback does, again and again.
double takeWhenThere(Request& request) {
  std::optional<Request::Question> question;
  while (!(question = request.take())) std::this_thread::yield();
  return *question;
}

TEST(ImageRequestTest, BringsTheAnswerBack) {
  Request request;
  EXPECT_FALSE(request.take());
  auto answer = std::async(std::launch::async, [&request] { return request.ask(kQuestion, 60.0, "late"); });
  EXPECT_EQ(takeWhenThere(request), 30.0);
  EXPECT_FALSE(request.take());
  request.answer({true, "selected"});
  const Request::Answer result = answer.get();
  EXPECT_TRUE(result.success);
  EXPECT_EQ(result.message, "selected");
}

TEST(ImageRequestTest, TimesOutWithoutAnImageAndIsThenForgotten) {
  Request request;
  const Request::Answer answer = request.ask(kQuestion, 0.01, "late");
  EXPECT_FALSE(answer.success);
  EXPECT_EQ(answer.message, "late");
  EXPECT_FALSE(request.take());
}

TEST(ImageRequestTest, WaitsOnOnceItIsTaken) {
  Request request;
  auto answer = std::async(std::launch::async, [&request] { return request.ask(kQuestion, 0.05, "late"); });
  // It may be too late for the first; then nothing is taken and nothing is left to test: ask again.
  std::optional<Request::Question> asked;
  while (!asked && answer.wait_for(std::chrono::seconds(0)) != std::future_status::ready) asked = request.take();
  if (!asked) GTEST_SKIP() << "the machine was too busy";
  std::this_thread::sleep_for(std::chrono::milliseconds(100));  // beyond the time-out: this is what is tested
  request.answer({true, "selected"});
  EXPECT_TRUE(answer.get().success);
}

TEST(ImageRequestTest, OneAfterTheOther) {
  Request request;
  auto first = std::async(std::launch::async, [&request] {
    return request.ask(1.0, 60.0, "late");
  });
  auto second = std::async(std::launch::async, [&request] {
    return request.ask(2.0, 60.0, "late");
  });
  for (int k = 0; k < 2; ++k) {
    const double asked = takeWhenThere(request);
    request.answer({true, asked == 1.0 ? "one" : "two"});
  }
  EXPECT_EQ(first.get().message, "one");
  EXPECT_EQ(second.get().message, "two");
}

TEST(ImageRequestTest, EndsAllWaitingWhenItIsClosed) {
  Request request;
  auto waiting = std::async(std::launch::async, [&request] { return request.ask(kQuestion, 600.0, "late"); });
  auto taken_never_answered = std::async(std::launch::async, [&request] { return request.ask(kQuestion, 600.0, "late"); });
  takeWhenThere(request);
  request.close();
  for (auto* answer : {&waiting, &taken_never_answered}) {
    const Request::Answer result = answer->get();
    EXPECT_FALSE(result.success);
    EXPECT_NE(result.message.find("shutting down"), std::string::npos);
  }
  EXPECT_FALSE(request.ask(kQuestion, 600.0, "late").success);
}

// Also if the image cannot be processed, nobody waits for an answer.
TEST(ImageRequestTest, IsAnsweredWhenAnExceptionIsThrown) {
  Request request;
  auto answer = std::async(std::launch::async, [&request] { return request.ask(kQuestion, 60.0, "late"); });
  bool taken = false;
  while (!taken) {
    try {
      AnswerGuard<Request> guard(request);
      taken = guard.question().has_value();
      if (taken) throw std::runtime_error("a bad image");
    } catch (const std::runtime_error&) {
    }
    std::this_thread::yield();
  }
  const TheAnswer result = answer.get();
  EXPECT_FALSE(result.success);
  EXPECT_EQ(result.message, "the image could not be processed");
}

}  // namespace
}  // namespace laparoscope_servo
