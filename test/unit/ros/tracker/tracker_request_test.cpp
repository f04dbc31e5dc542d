#include "ros/tracker/tracker_request.h"

#include <gtest/gtest.h>

#include <future>
#include <thread>

namespace laparoscope_servo {
namespace {

const geometry::Rectangle kRoi{1.0, 2.0, 30.0, 40.0};

// As the image callback does, again and again.
geometry::Rectangle takeWhenThere(TrackerRequest& request) {
  std::optional<TrackerRequest::Question> question;
  while (!(question = request.take())) std::this_thread::yield();
  return std::get<geometry::Rectangle>(*question);
}

TEST(TrackerRequestTest, BringsTheAnswerBack) {
  TrackerRequest request;
  EXPECT_FALSE(request.take());
  auto answer = std::async(std::launch::async, [&request] { return request.ask(kRoi, 60.0, "late"); });
  EXPECT_EQ(takeWhenThere(request).width, 30.0);
  EXPECT_FALSE(request.take());
  request.answer({true, "selected"});
  const TrackerRequest::Answer result = answer.get();
  EXPECT_TRUE(result.success);
  EXPECT_EQ(result.message, "selected");
}

TEST(TrackerRequestTest, TimesOutWithoutAnImageAndIsThenForgotten) {
  TrackerRequest request;
  const TrackerRequest::Answer answer = request.ask(kRoi, 0.01, "late");
  EXPECT_FALSE(answer.success);
  EXPECT_EQ(answer.message, "late");
  EXPECT_FALSE(request.take());
}

TEST(TrackerRequestTest, WaitsOnOnceItIsTaken) {
  TrackerRequest request;
  auto answer = std::async(std::launch::async, [&request] { return request.ask(kRoi, 0.05, "late"); });
  // It may be too late for the first; then nothing is taken and nothing is left to test: ask again.
  std::optional<TrackerRequest::Question> roi;
  while (!roi && answer.wait_for(std::chrono::seconds(0)) != std::future_status::ready) roi = request.take();
  if (!roi) GTEST_SKIP() << "the machine was too busy";
  std::this_thread::sleep_for(std::chrono::milliseconds(100));  // beyond the time-out: this is what is tested
  request.answer({true, "selected"});
  EXPECT_TRUE(answer.get().success);
}

TEST(TrackerRequestTest, OneAfterTheOther) {
  TrackerRequest request;
  auto first = std::async(std::launch::async, [&request] {
    return request.ask(geometry::Rectangle{0, 0, 1, 1}, 60.0, "late");
  });
  auto second = std::async(std::launch::async, [&request] {
    return request.ask(geometry::Rectangle{0, 0, 2, 2}, 60.0, "late");
  });
  for (int k = 0; k < 2; ++k) {
    const geometry::Rectangle roi = takeWhenThere(request);
    request.answer({true, roi.width == 1.0 ? "one" : "two"});
  }
  EXPECT_EQ(first.get().message, "one");
  EXPECT_EQ(second.get().message, "two");
}

TEST(TrackerRequestTest, EndsAllWaitingWhenItIsClosed) {
  TrackerRequest request;
  auto waiting = std::async(std::launch::async, [&request] { return request.ask(kRoi, 600.0, "late"); });
  auto taken_never_answered = std::async(std::launch::async, [&request] { return request.ask(kRoi, 600.0, "late"); });
  takeWhenThere(request);
  request.close();
  for (auto* answer : {&waiting, &taken_never_answered}) {
    const TrackerRequest::Answer result = answer->get();
    EXPECT_FALSE(result.success);
    EXPECT_NE(result.message.find("shutting down"), std::string::npos);
  }
  EXPECT_FALSE(request.ask(kRoi, 600.0, "late").success);
}

}  // namespace
}  // namespace laparoscope_servo
