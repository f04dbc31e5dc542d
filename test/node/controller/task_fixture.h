// A controller whose task goes by what one source tells, among the fake cart: what every such task is tried for.
#pragma once

#include <laparoscope_servo/SelectTask.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "controller_fixture.h"

namespace laparoscope_servo {

// `Source`: MotionFeed, HomographyFeed.
template <typename Source>
class TaskFixture : public ControllerFixture {
 protected:
  using Words = typename Source::Words;
  using Message = decltype(Words::message);
  struct Loss {
    const char* name;
    std::function<void(Words&)> apply;
    const char* reason;
  };

  // `topic`: where the source speaks. `tasks`: are selected one after the other before each test; the last one is
  // tested. `seen`: what it is shown when nothing is missing.
  TaskFixture(const std::string& topic, std::vector<std::string> tasks, std::function<Message()> seen)
      : feed_(source(topic)), tasks_(std::move(tasks)), seen_(std::move(seen)) {}

  // One for all tests of a process; the first call says its topic.
  static Source& source(const std::string& topic = "") {
    static Source instance(topic);
    return instance;
  }
  static void TearDownTestSuite() {
    source().end();
    ControllerFixture::TearDownTestSuite();
  }

  void SetUp() override {
    show();
    ControllerFixture::SetUp();
    prepareCart();
    for (const std::string& task : tasks_) select(task);
  }
  virtual void prepareCart() {
    // The region of interest is silent: nothing of it is needed.
    cart_.set([](Feed& feed) { feed.task_error = false; });
  }

  void select(const std::string& task) {
    SelectTask call;
    call.request.task = task;
    ASSERT_TRUE(ros::service::call("/controller/select_task", call) && call.response.success) << call.response.message;
    ASSERT_TRUE(waitFor([&] { return cart_.state().task == task; }));
  }
  void show(const Message& message) {
    feed_.set([&](Words& words) { words = Words{}, words.message = message; });
  }
  void show() { show(seen_()); }
  void engageAndMove() {
    ASSERT_TRUE(cart_.engageWhenReady()) << cart_.answer();
    ASSERT_TRUE(cart_.waitForState(ControllerState::SERVO)) << cart_.state().reason;
    ASSERT_TRUE(waitFor([this] { return cart_.moves(); }));
  }
  // The controller may still have the camera_info of the test before, which ends the first engagement.
  void engageAgainAndMove() {
    ASSERT_TRUE(cart_.engageWhenReady()) << cart_.answer();
    ASSERT_TRUE(waitFor([this] {
      if (cart_.state().state == ControllerState::LOST) cart_.engageWhenReady();
      return cart_.state().state == ControllerState::SERVO && cart_.moves();
    })) << cart_.state().reason;
  }
  bool waitForReason(const std::string& reason) {
    return waitFor([&] { return cart_.state().reason.find(reason) != std::string::npos; });
  }
  // What is said when somebody wants to engage now.
  bool waitForRefusal(const std::string& reason) {
    return waitFor([&] {
      bool success = true;
      const std::string answer = cart_.engage(true, success);
      if (success) cart_.engage(false, success);
      return answer.find("not engaged") != std::string::npos && answer.find(reason) != std::string::npos;
    });
  }

  void lose(const Loss& loss) {
    feed_.set(loss.apply);
    ASSERT_TRUE(waitForReason(loss.reason)) << loss.name << ": " << cart_.state().reason;
    EXPECT_TRUE(cart_.stands()) << loss.name;
  }
  void eachLossStopsIt(const std::vector<Loss>& losses) {
    for (const Loss& loss : losses) {
      engageAndMove();
      lose(loss);
      if (HasFatalFailure()) return;
      ASSERT_TRUE(cart_.waitForState(ControllerState::LOST)) << loss.name << ": " << cart_.state().reason;
      show();
    }
  }
  // It goes on by itself where what was lost comes back soon enough.
  void eachLossHoldsIt(const std::vector<Loss>& losses) {
    for (const Loss& loss : losses) {
      if (cart_.state().state != ControllerState::SERVO) engageAgainAndMove();
      lose(loss);
      if (HasFatalFailure()) return;
      show();
      ASSERT_TRUE(waitFor([this] {
        const std::string state = cart_.state().state;
        return state == ControllerState::SERVO || state == ControllerState::LOST;
      })) << loss.name;
    }
  }
  void eachLossIsRefusedByName(const std::vector<Loss>& losses) {
    for (const Loss& loss : losses) {
      bool success = false;
      ASSERT_TRUE(cart_.engageWhenReady()) << cart_.answer();  // nothing is missing yet
      cart_.engage(false, success);
      feed_.set(loss.apply);
      EXPECT_TRUE(waitForRefusal(loss.reason)) << loss.name << ": " << cart_.answer();
      show();
    }
  }
  // It moves; `expectLeft` says what is true once HOLD_VIEW has been selected.
  void isLeftAndTakenUpAgain(const std::function<void()>& expectLeft) {
    engageAndMove();
    select(SelectTask::Request::HOLD_VIEW);
    expectLeft();
    select(tasks_.back());
    bool success = false;
    cart_.engage(false, success);
    ASSERT_TRUE(cart_.waitForState(ControllerState::IDLE));
    engageAndMove();
  }
  // While it moves.
  void anotherCalibrationEndsIt(double focal_length) {
    feed_.set([=](Words& w) { w.focal_length = focal_length; });
    ASSERT_TRUE(cart_.waitForState(ControllerState::LOST)) << cart_.state().reason;
    EXPECT_TRUE(waitForReason("camera_info has another calibration")) << cart_.state().reason;
    EXPECT_TRUE(cart_.stands());
  }
  void timeThatJumpsBackIsAFault(const std::string& reason) {
    feed_.set([](Words& w) { w.stamp_offset = -1.0; });
    ASSERT_TRUE(cart_.waitForState(ControllerState::FAULT)) << cart_.state().reason;
    EXPECT_NE(cart_.state().reason.find(reason), std::string::npos) << cart_.state().reason;
    EXPECT_TRUE(cart_.stands());
  }
  void withoutTheScopesPoseItStands() {
    cart_.set([](Feed& feed) { feed.tf = false; });
    ASSERT_TRUE(cart_.waitForState(ControllerState::HOLD)) << cart_.state().reason;
    EXPECT_TRUE(cart_.stands());
  }

  Source& feed_;

 private:
  std::vector<std::string> tasks_;
  std::function<Message()> seen_;
};

}  // namespace laparoscope_servo
