#include "laparoscope_servo/servo/dead_man_switch.h"

#include <algorithm>

namespace laparoscope_servo::servo {

namespace {

// Number of sources kept, more than there are switches in a room; bounds the memory if publishers connect again and
// again. A forgotten source must be seen released again.
constexpr std::size_t kSources = 16;

}  // namespace

void DeadManSwitch::engaging() {
  for (Word& word : words_) word.counts = false;
}

void DeadManSwitch::said(const Source& source, bool pressed, bool may_press, double now) {
  auto word = std::find_if(words_.begin(), words_.end(), [&](const Word& w) { return w.source == source; });
  if (word == words_.end()) {
    const auto older = [](const Word& a, const Word& b) { return a.time < b.time; };
    if (words_.size() >= kSources) words_.erase(std::min_element(words_.begin(), words_.end(), older));
    word = words_.insert(words_.end(), Word{source});
  }
  word->counts = may_press && (word->counts || !pressed);
  word->pressed = pressed;
  word->time = now;
}

DeadManFacts DeadManSwitch::facts(double now) const {
  DeadManFacts pressed, held;
  for (const Word& word : words_) {
    const double age = now - word.time;
    if (!(age >= 0.0 && age <= max_age_)) continue;
    if (!word.pressed) return {false, age, ""};
    DeadManFacts& facts = word.counts ? pressed : held;
    if (age < facts.age) facts = {word.counts, age, ""};
  }
  if (pressed.pressed) return pressed;
  if (held.age <= max_age_) held.problem = "the dead-man switch was not seen released since engaging: release it once";
  return held;
}

}  // namespace laparoscope_servo::servo
