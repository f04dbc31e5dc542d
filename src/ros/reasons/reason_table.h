// What each reason of the nodes means, in a sentence that needs no knowledge of the program, and what to do about it.
//
// Of tracker/state, controller/state (reason and caution) and aesop/operating_state. The screen shows it, and the part
// "Reasons of the states" of doc/troubleshooting.md is made from it; a test compares the two, and another finds the
// reason in a source that is missing here.
#pragma once

#include <string>
#include <vector>

namespace laparoscope_servo {

enum class Speaker { kTracker, kController, kRobot };

struct ReasonRow {
  std::vector<std::string> patterns;  // a reason has one of them in it; each `…` is any text
  std::string sentence;               // what it means
  std::string cure;                   // what to do
  std::string page = {};              // in doc/, that tells more; empty: none
};

// In the order of looking up: a reason may have other reasons in it, and the first row that fits counts.
const std::vector<ReasonRow>& reasonRows(Speaker speaker);

// Whether the pieces of `pattern` between its `…` stand in `text`, in their order.
bool fits(const std::string& pattern, const std::string& text);

// Null when no row fits.
const ReasonRow* explain(Speaker speaker, const std::string& reason);

// The part of the page, in Markdown.
std::string reasonPage();

}  // namespace laparoscope_servo
