// Stamps of images that go at `rate` of the clock from the first one on; the images themselves are true, and come in
// time.
#pragma once

#include <optional>

#include "laparoscope_servo/servo/controller.h"

namespace laparoscope_servo::test {

class SlowStamps {
 public:
  explicit SlowStamps(double rate) : rate_(rate) {}

  void operator()(servo::ControllerInput& input) {
    servo::TaskErrorInput& seen = input.task_error;
    if (!seen.image_time) return;
    if (!first_) first_ = *seen.image_time;
    const double stamp = *first_ + rate_ * (*seen.image_time - *first_);
    seen.image_age += *seen.image_time - stamp;
    seen.image_time = stamp;
  }

 private:
  double rate_;
  std::optional<double> first_;
};

}  // namespace laparoscope_servo::test
