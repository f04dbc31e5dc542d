#include "screen/task_words.h"

#include <algorithm>

namespace laparoscope_servo::screen {

const std::vector<TaskWords>& taskWords() {
  static const std::vector<TaskWords> all{
      {"HOLD_VIEW", "Hold region", "the scope brings the region back to where it was selected, and holds it there.",
       "a region, and the camera's calibration.", "The scope follows the region."},
      {"MANUAL", "By hand", "the scope moves while a slider or a stick is held. No picture is looked at, but by you.",
       "the sliders below, or a stick.", "The scope is driven by hand."},
      {"STABILISE", "Hold view",
       "the scope turns so that all of the view stays as it was when \"Keep this view\" was pressed.",
       "the node motion, and the camera's calibration.", "The scope holds the whole view."},
      {"CENTRE_TIP", "Centre tip", "the scope turns to an instrument whose tip is held still away from the middle.",
       "the node instrument, and the camera's calibration.", "The scope keeps the tip near the middle."}};
  return all;
}

const TaskWords* wordsOfTask(const std::string& task) {
  const std::vector<TaskWords>& all = taskWords();
  const auto found = std::find_if(all.begin(), all.end(), [&](const TaskWords& words) { return words.task == task; });
  return found == all.end() ? nullptr : &*found;
}

std::string nameOfTask(const std::string& task) {
  const TaskWords* words = wordsOfTask(task);
  return words == nullptr ? task : words->name;
}

// A task that is selected while the controller is engaged begins by itself.
std::string promise(const TaskWords& words, const std::string& current, bool engaged, bool moves) {
  if (engaged && words.task == current) return (moves ? "Now " : "When nothing is missing, ") + words.does;
  return (engaged ? "At once, if pressed, " : "Once engaged, ") + words.does + " Needs " + words.needs;
}

}  // namespace laparoscope_servo::screen
