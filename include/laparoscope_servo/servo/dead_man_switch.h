// What the dead-man switch says, when several may say it.
//
// "Released" counts from everybody, while it is fresh. "Pressed" counts from a source only once that source has said
// "released" since the engaging: a publisher that was forgotten and says "pressed" for ever never counts, and a switch
// that is held down while somebody engages has to be let go once.
#pragma once

#include <memory>
#include <vector>

#include "laparoscope_servo/servo/safety_facts.h"

namespace laparoscope_servo::servo {

class DeadManSwitch {
 public:
  // One for each connection; kept, so that its address is not used again.
  using Source = std::shared_ptr<const void>;

  // `max_age`: s, an older word does not count.
  explicit DeadManSwitch(double max_age) : max_age_(max_age) {}

  // Somebody engages: every source has to be seen released.
  void engaging();
  // `now`: s. `may_press`: false, only its "released" counts.
  void said(const Source& source, bool pressed, bool may_press, double now);
  DeadManFacts facts(double now) const;

 private:
  struct Word {
    Source source;
    bool pressed = false;
    bool counts = false;  // as "pressed": it may, and was seen released
    double time = 0.0;    // s
  };

  double max_age_;
  std::vector<Word> words_;  // the last one of each source
};

}  // namespace laparoscope_servo::servo
