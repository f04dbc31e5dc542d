// What each task of the controller does, in words. Uses no ROS and no widgets.
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo::screen {

struct TaskWords {
  std::string task;    // of ControllerState
  std::string name;    // of its button
  std::string does;    // what the scope does while the controller is engaged; begins in lower case
  std::string needs;   // what has to be there for it
  std::string serves;  // a sentence that is true in the state SERVO
};

// In the order of their buttons.
const std::vector<TaskWords>& taskWords();

// Null: the screen does not know this task.
const TaskWords* wordsOfTask(const std::string& task);

// The name of its button, or what the controller calls it.
std::string nameOfTask(const std::string& task);

// What comes of pressing the button of the task. `current`: the task of the controller; `engaged`, `moves`: it is, and
// is in SERVO.
std::string promise(const TaskWords& words, const std::string& current, bool engaged, bool moves);

}  // namespace laparoscope_servo::screen
