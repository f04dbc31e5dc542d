// What is left of the time that the search may take in an image, by nominal costs.
#pragma once

namespace laparoscope_servo::tracking {

class SearchBudget {
 public:
  // A new image, with so many seconds.
  void start(double seconds) {
    left_ = seconds;
    idle_ = true;
  }
  // Whether a piece that costs so much may be done, which is then paid for. The first one of an image always may: the
  // search goes on, however dear a piece is.
  bool pay(double cost) {
    if (!idle_ && cost > left_) return false;
    idle_ = false;
    left_ -= cost;
    return true;
  }
  // The same for a trifle, which does not count as the first piece.
  bool payTrifle(double cost) {
    if (cost > left_) return false;
    left_ -= cost;
    return true;
  }

  // A piece that was paid for has cost so much more, or less.
  void charge(double more) { left_ -= more; }

 private:
  double left_ = 0.0;  // s
  bool idle_ = true;   // nothing was done yet
};

}  // namespace laparoscope_servo::tracking
