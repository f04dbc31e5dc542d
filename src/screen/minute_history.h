// What the tracker has said in the last minute, in steps of half a second: of each value the least and the greatest. No
// ROS and no widgets here.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace laparoscope_servo::screen {

enum Quantity { kConfidence, kCornerError, kVisible, kRate, kDelay, kQuantities };

class MinuteHistory {
 public:
  static constexpr int kSteps = 120;
  static constexpr double kStep = 0.5;  // s

  struct Range {
    double low = 0.0;
    double high = 0.0;
    bool known = false;
    void add(double value);
  };
  struct Step {
    std::array<Range, kQuantities> ranges;
    int images = 0;
    bool tracked = true;  // in all images
  };

  // At `now` [s, steady] of an image: correlation, px, share, s. What is not finite is not known.
  void add(double now, bool tracked, double confidence, double corner_error, double visible, double delay);
  // The last minute until `now`, the oldest first; the last step is not over. Steps without an image have none.
  std::vector<Step> steps(double now) const;

 private:
  struct Numbered {
    std::int64_t number = -1;
    Step step;
  };
  std::array<Numbered, kSteps + 1> ring_;
};

}  // namespace laparoscope_servo::screen
