// Explains each reason of the nodes in a sentence for a user, with what to do about it.
//
// Covers tracker/state, ~features of the trackers of features, controller/state (reason and caution),
// aesop/operating_state and player/state. The screen shows it, and the part "Reasons of the states" of
// doc/troubleshooting.md is generated from it. One test compares both, another finds reasons in the sources that are
// missing here.
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo {

enum class Speaker { kTracker, kFeatures, kController, kRobot, kPlayer };

struct ReasonRow {
  std::vector<std::string> patterns;  // patterns, one of which the reason contains; each `…` stands for any text
  std::string sentence;               // what it means
  std::string cure;                   // what to do
  std::string page = {};              // page in doc/ with more; empty: none
};

// Rows in the order of searching: a reason may contain other reasons, and the first row that fits is used.
const std::vector<ReasonRow>& reasonRows(Speaker speaker);

// Whether `text` contains the pieces of `pattern` between its `…`, in their order.
bool fits(const std::string& pattern, const std::string& text);

// The first row that fits, or null.
const ReasonRow* explain(Speaker speaker, const std::string& reason);

// The part of the page, in Markdown.
std::string reasonPage();

}  // namespace laparoscope_servo
