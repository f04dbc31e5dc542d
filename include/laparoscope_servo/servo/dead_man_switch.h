// State of the dead-man switch, from one or several publishers.
//
// A recent "released" of any source counts. "Pressed" of a source counts only after it published "released" since the
// engaging: a forgotten publisher that always sends "pressed" never counts, and a switch that is held down while
// engaging must be released once.
#pragma once

#include <memory>
#include <vector>

#include "laparoscope_servo/servo/safety_facts.h"

namespace laparoscope_servo::servo {

class DeadManSwitch {
 public:
  // Identifies a connection; kept alive, so that its address is not used again.
  using Source = std::shared_ptr<const void>;

  // `max_age`: s, an older message does not count.
  explicit DeadManSwitch(double max_age) : max_age_(max_age) {}

  // Call when engaging: every source must be seen released again.
  void engaging();
  // Takes a message of a source. `now`: s. `may_press`: false if only "released" counts from it.
  void said(const Source& source, bool pressed, bool may_press, double now);
  DeadManFacts facts(double now) const;

 private:
  struct Word {
    Source source;
    bool pressed = false;
    bool counts = false;  // "pressed" counts: the source may press, and was seen released
    double time = 0.0;    // s
  };

  double max_age_;
  std::vector<Word> words_;  // the last message of each source
};

}  // namespace laparoscope_servo::servo
