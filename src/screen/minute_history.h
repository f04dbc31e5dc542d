// The tracker's figures of the last minute: least and greatest value in steps of half a second. Uses no ROS and no
// widgets.
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
    bool tracked = true;  // TRACKING in all images
  };

  // Adds the figures of an image at `now` [s, steady]: correlation, px, share, s. Non-finite values are unknown.
  void add(double now, bool tracked, double confidence, double corner_error, double visible, double delay);
  // The last minute until `now`, the oldest first; the last step is incomplete. Steps without an image have no values.
  std::vector<Step> steps(double now) const;

 private:
  struct Numbered {
    std::int64_t number = -1;
    Step step;
  };
  std::array<Numbered, kSteps + 1> ring_;
};

}  // namespace laparoscope_servo::screen
