#include "screen/task_words.h"

#include <algorithm>

namespace laparoscope_servo::screen {

const std::vector<TaskWords>& taskWords() {
  static const std::vector<TaskWords> all{
      {"HOLD_VIEW", "Hold region", "the scope brings the region back to where it was selected, and holds it.",
       "a region and a calibrated camera.", "The scope follows the region."},
      {"MANUAL", "By hand", "the scope moves while a slider or stick is held. Only you watch the picture.",
       "the sliders below or a stick.", "The scope is driven by hand."},
      {"STABILISE", "Stabilise", "the scope turns to keep the view as it was at \"Keep this view\".",
       "the node motion and a calibrated camera.", "The scope holds the whole view."},
      {"CENTRE_TIP", "Centre tip", "the scope turns to a tip that is held still away from the middle.",
       "the node instrument and a calibrated camera.", "The scope keeps the tip near the middle."},
      {"FOLLOW", "Follow object", "the scope turns to keep the selected object in the middle.",
       "the node motion and a calibrated camera.", "The scope follows the object."},
      {"POINTS", "Bring points", "the scope brings the selected points to their places.",
       "the node points and a calibrated camera.", "The scope brings the points to their places."},
      {"POSITION", "Bring back", "the scope brings the region back by its homography.",
       "a tracked region and a calibrated camera.", "The scope brings the region back."},
      {"PARALLEL", "Face tissue", "the scope circles; engaged again, it turns to face the tissue.",
       "the node motion, tf and a calibrated camera.", "The scope turns to face the tissue."}};
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
