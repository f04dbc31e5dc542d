// Faults of strangers: wrong units, a film that is played over and over, another lens, stamps that lose time, a slow
// camera, an insertion point that slips.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "support/cart_fault.h"
#include "support/slow_stamps.h"

namespace laparoscope_servo::test {

// Each call draws one, with its numbers.
class CartStrangerFaults : public Draws {
 public:
  using Draws::Draws;

  // `manual`: the task is MANUAL, in which stamps of images do not count.
  CartFault ofStranger(bool manual) {
    static const Maker makers[] = {&CartStrangerFaults::otherLens,        &CartStrangerFaults::slowCamera,
                                   &CartStrangerFaults::rollingOptics,    &CartStrangerFaults::velocityInOtherUnits,
                                   &CartStrangerFaults::poseInOtherUnits, &CartStrangerFaults::depthByAnotherFactor,
                                   &CartStrangerFaults::slippingPoint,    &CartStrangerFaults::slowStamps};
    return (this->*makers[whole(manual ? 7 : 8)])();
  }

 private:
  using Input = servo::ControllerInput;
  using Seen = servo::TaskErrorInput;
  using Maker = CartFault (CartStrangerFaults::*)();

  CartFault otherLens() {
    const double radial = sign() * real(0.1, 0.4);
    return bearable(
        withTracker("a lens that distorts by " + std::to_string(radial) + " otherwise", [radial](Seen& seen) {
          const double r2 = seen.error.x * seen.error.x + seen.error.y * seen.error.y;
          for (double* value : {&seen.error.x, &seen.error.y}) *value *= 1.0 + radial * r2;
        }));
  }

  CartFault slowStamps() {
    const double rate = real(0.0, 0.6);
    return withInput("stamps that go " + std::to_string(rate) + " times as fast",
                     std::function<void(Input&)>(SlowStamps(rate)));
  }

  CartFault slowCamera() {
    const int every = 2 + whole(10);
    const auto kept = std::make_shared<std::optional<Seen>>();
    const auto since = std::make_shared<double>(0.0);
    const auto last = std::make_shared<double>(-1.0);
    const auto count = std::make_shared<int>(0);
    return bearable(withInput("1 in " + std::to_string(every) + " images comes", [=](Input& input, double time) {
      Seen& seen = input.task_error;
      if (seen.image_time && *seen.image_time != *last) {
        *last = *seen.image_time;
        if ((*count)++ % every == 0) {
          *kept = seen;
          *since = time;
        }
      }
      if (!*kept) return;
      const double later = time - *since;
      seen = **kept;
      seen.age += later;
      seen.image_age += later;
    }));
  }

  CartFault velocityInOtherUnits() {
    const double factor = whole(2) == 0 ? 180.0 / M_PI : 1000.0;
    return bearable(withInput("reports its velocity times " + std::to_string(factor), [factor](Input& input) {
      input.robot_report.velocity = scope::Velocity::fromVector(factor * input.robot_report.velocity.vector());
    }));
  }

  CartFault poseInOtherUnits() {
    const double factor = whole(2) == 0 ? 1e3 : 1e-3;
    return withInput("translations of tf times " + std::to_string(factor),
                     [factor](Input& input) { scalePose(input.depth, factor); });
  }

  CartFault depthByAnotherFactor() {
    const double factor = whole(2) == 0 ? real(0.4, 0.8) : real(1.25, 2.0);
    return bearable(withInput("translations of tf times " + std::to_string(factor),
                              [factor](Input& input) { scalePose(input.depth, factor); }));
  }

  static void scalePose(servo::DepthInput& depth, double factor) {
    depth.d2 *= factor;
    depth.lateral_offset *= factor;
    if (depth.insertion_point_T_tip) depth.insertion_point_T_tip->translation() *= factor;
  }

  // The trocar goes sideways with the abdominal wall, and tf says where it was.
  CartFault slippingPoint() {
    const double speed = real(0.0005, 0.0025);  // m/s; where it was is not measured anew after it
    const auto begin = std::make_shared<std::optional<double>>();
    return bearable(withInput("the insertion point slips by " + std::to_string(1e3 * speed) + " mm/s",
                              [=](Input& input, double time) {
                                if (!*begin) *begin = time;
                                const double slipped = speed * (time - **begin);
                                input.depth.lateral_offset += slipped;
                                if (input.depth.insertion_point_T_tip)
                                  input.depth.insertion_point_T_tip->translation().x() += slipped;
                              }));
  }

  // A camera head that turns by itself, from what it is to upside down.
  CartFault rollingOptics() {
    const double rate = sign() * real(0.2, 2.0);  // rad/s
    const auto images = std::make_shared<int>(0);
    CartFault fault = bearable(CartFault());
    fault.name = "optics that roll by " + std::to_string(rate) + " rad/s";
    fault.blinds = true;
    fault.interference.picture = [=](Eigen::Matrix3d& h) {
      const double roll = std::clamp(rate * 0.04 * ++*images, -M_PI, M_PI);
      const Eigen::Matrix3d turn = geometry::so3Exp({0.0, 0.0, roll});
      h = turn * h;
    };
    return fault;
  }
};

}  // namespace laparoscope_servo::test
