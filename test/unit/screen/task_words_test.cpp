#include "screen/task_words.h"

#include <gtest/gtest.h>
#include <laparoscope_servo/ControllerState.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "laparoscope_servo/servo/task.h"
#include "ros/controller/controller_conversions.h"

namespace laparoscope_servo::screen {
namespace {

TEST(TaskWords, EachTaskOfTheControllerHasItsOwn) {
  ASSERT_EQ(taskWords().size(), std::size(servo::kTasks));
  std::set<std::string> names, sentences;
  for (const servo::Task task : servo::kTasks) {
    const TaskWords* words = wordsOfTask(taskName(task));
    ASSERT_NE(words, nullptr) << taskName(task);
    EXPECT_EQ(nameOfTask(taskName(task)), words->name);
    names.insert(words->name);
    for (const std::string& text : {words->does, words->needs, words->serves}) {
      ASSERT_FALSE(text.empty()) << words->task;
      EXPECT_EQ(text.back(), '.') << text;
      sentences.insert(text);
    }
    EXPECT_TRUE(std::islower(static_cast<unsigned char>(words->does[0]))) << words->does;
  }
  EXPECT_EQ(names.size(), taskWords().size());
  EXPECT_GE(sentences.size(), 3 * taskWords().size() - 1) << "STABILISE and CENTRE_TIP need a node each";
}

TEST(TaskWords, ATaskThatIsNoneHasNone) {
  EXPECT_EQ(wordsOfTask(""), nullptr);
  EXPECT_EQ(wordsOfTask("hold_view"), nullptr);
  EXPECT_EQ(nameOfTask("JUGGLE"), "JUGGLE");
}

TEST(TaskWords, WhatWillComeIsSaidBeforeItIsEngaged) {
  const TaskWords& hold = *wordsOfTask(ControllerState::HOLD_VIEW);
  const std::string before = promise(hold, ControllerState::HOLD_VIEW, false, false);
  EXPECT_EQ(before.find("Once engaged, "), 0u) << before;
  EXPECT_NE(before.find(hold.does), std::string::npos);
  EXPECT_NE(before.find(hold.needs), std::string::npos);
  EXPECT_EQ(promise(hold, ControllerState::MANUAL, false, false), before) << "another task changes nothing in it";
  EXPECT_EQ(promise(hold, ControllerState::HOLD_VIEW, true, true), "Now " + hold.does);
  EXPECT_EQ(promise(hold, ControllerState::HOLD_VIEW, true, false), "When nothing is missing, " + hold.does)
      << "ARMED or HOLD: it stands";
  const std::string at_once = promise(hold, ControllerState::MANUAL, true, true);
  EXPECT_EQ(at_once.find("At once, if pressed, "), 0u) << "an engaged controller does not wait: " << at_once;
}

}  // namespace
}  // namespace laparoscope_servo::screen
