// Faults of where the controller's inputs come from: sources that take turns, buffers that deliver something old, a
// camera or an arm that is another one than configured. None has to stop the scope by itself; none may lead it away.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <random>
#include <string>

#include "support/cart_stranger_faults.h"

namespace laparoscope_servo::test {

// Each call draws one, with its numbers.
class CartSourceFaults : public CartStrangerFaults {
 public:
  using CartStrangerFaults::CartStrangerFaults;

  CartFault ofSource() {
    static const Maker makers[] = {
        &CartSourceFaults::eachTwice,     &CartSourceFaults::twoViews,   &CartSourceFaults::oldBetween,
        &CartSourceFaults::fillingBuffer, &CartSourceFaults::stuttering, &CartSourceFaults::otherFocalLength,
        &CartSourceFaults::trembling,     &CartSourceFaults::twoPoses,   &CartSourceFaults::oldPose};
    return bearable((this->*makers[whole(9)])());
  }

  CartFault ofArm() {
    static const Maker makers[] = {&CartSourceFaults::reversedAxis, &CartSourceFaults::otherSpeed,
                                   &CartSourceFaults::later, &CartSourceFaults::motionOfAnother};
    return bearable((this->*makers[whole(4)])());
  }

 protected:
  static constexpr double kFocalLength = 400.0;  // px, of the simulated cart

  // By so much of the focal length.
  static void shift(servo::TaskErrorInput& seen, double x, double y) {
    seen.error.x += x;
    seen.error.y += y;
    if (!seen.motion) return;
    Eigen::Matrix3d change = Eigen::Matrix3d::Identity();
    change.topRightCorner<2, 1>() << x, y;
    seen.motion->h = change * seen.motion->h;
  }

 private:
  using Seen = servo::TaskErrorInput;
  using Maker = CartFault (CartSourceFaults::*)();

  // Only the errors: each image has a stamp of its own.
  static void showInstead(Seen& seen, const Seen& other) {
    seen.error = other.error;
    seen.motion = other.motion;
    seen.valid = other.valid;
  }

  CartFault eachTwice() {
    const auto last = std::make_shared<Seen>();
    const auto count = std::make_shared<int>(0);
    return withTracker("each image twice", [=](Seen& seen) {
      if (++*count % 2 == 0) showInstead(seen, *last);
      *last = seen;
    });
  }

  CartFault twoViews() {
    const double aside = sign() * real(20.0, 120.0) / kFocalLength;
    const double deeper = real(-0.2, 0.2);
    const auto count = std::make_shared<int>(0);
    return withTracker("two views in turn", [=](Seen& seen) {
      if (++*count % 2 != 0) return;
      shift(seen, aside, 0.0);
      seen.error.log_depth += deeper;
    });
  }

  CartFault oldBetween() {
    const auto kept = std::make_shared<std::deque<Seen>>();
    const auto count = std::make_shared<int>(0);
    const std::size_t images = 2 + static_cast<std::size_t>(whole(20));
    CartFault fault = withTracker("every second image " + std::to_string(images) + " old", [=](Seen& seen) {
      kept->push_back(seen);
      if (kept->size() > images + 1) kept->pop_front();
      if (++*count % 2 == 0) showInstead(seen, kept->front());
    });
    fault.blinds = true;  // half of what a mirror would show in is of before
    return fault;
  }

  CartFault fillingBuffer() {
    const auto kept = std::make_shared<std::deque<Seen>>();
    const auto due = std::make_shared<double>(0.0);
    const auto last = std::make_shared<Seen>();
    const double share = real(0.5, 0.9);
    return withTracker("a buffer that fills, read " + std::to_string(share) + " times as fast", [=](Seen& seen) {
      kept->push_back(seen);
      *due += share;
      if (*due >= 1.0) {
        *due -= 1.0;
        *last = kept->front();
        kept->pop_front();
      }
      if (kept->size() > 1) showInstead(seen, *last);
    });
  }

  CartFault stuttering() {
    const auto first = std::make_shared<Seen>();
    const auto count = std::make_shared<int>(0);
    const int period = 15 + whole(20), stands = 5 + whole(8);
    return withTracker("stands for " + std::to_string(stands) + " of " + std::to_string(period) + " images",
                       [=](Seen& seen) {
                         const int at = (*count)++ % period;
                         if (at == 0) *first = seen;
                         if (at < stands) showInstead(seen, *first);
                       });
  }

  CartFault otherFocalLength() {
    const double factor = whole(2) == 0 ? real(0.4, 0.7) : real(1.4, 2.0);
    return withTracker("focal length " + std::to_string(factor) + " times as long", [factor](Seen& seen) {
      for (double* value : {&seen.error.x, &seen.error.y, &seen.error.desired_x, &seen.error.desired_y})
        *value *= factor;
      if (!seen.motion) return;
      const Eigen::DiagonalMatrix<double, 3> longer(factor, factor, 1.0);
      seen.motion->h = longer * seen.motion->h * longer.inverse();
      for (Eigen::Vector2d& corner : seen.motion->corners) corner *= factor;
    });
  }

  CartFault trembling() {
    const double most = real(2.0, 10.0) / kFocalLength;
    const auto random = std::make_shared<Draws>(static_cast<unsigned>(whole(1000000)));
    return withTracker("trembles by " + std::to_string(most * kFocalLength) + " px", [=](Seen& seen) {
      const double x = random->real(-most, most);
      shift(seen, x, random->real(-most, most));
    });
  }

  // As by a second node that says where the scope is.
  CartFault twoPoses() {
    const Eigen::Matrix3d turn = geometry::so3Exp({0.0, 0.0, sign() * real(0.1, M_PI)});
    const double deeper = real(-0.04, 0.04);
    const auto count = std::make_shared<int>(0);
    return withInput("two poses in turn", [=](servo::ControllerInput& input) {
      if (++*count % 2 != 0) return;
      input.depth.camera_R_shaft = turn * input.depth.camera_R_shaft;
      input.depth.d2 += deeper;
    });
  }

  CartFault oldPose() {
    const auto first = std::make_shared<std::deque<servo::DepthInput>>();
    return withInput("the pose stands", [first](servo::ControllerInput& input) {
      if (first->empty()) first->push_back(input.depth);
      const double age = input.depth.age;
      input.depth = first->front();
      input.depth.age = age;
    });
  }

  CartFault reversedAxis() {
    static const char* const kAxes[] = {"pan", "tilt", "spin", "insertion"};
    const int axis = whole(4);
    const bool lies = whole(2) == 0;
    CartFault fault = withRobot(
        std::string(kAxes[axis]) + " reversed, " + (lies ? "says that it is not" : "says so"),
        [=](SimulatedCart& cart) {
          cart.gain[axis] *= -1.0;
          if (lies) ++cart.says_what_it_is_told;
        },
        [=](SimulatedCart& cart) {
          cart.gain[axis] *= -1.0;
          if (lies) --cart.says_what_it_is_told;
        });
    fault.blinds = true;  // in a mirrored picture a reversed pan is right
    return fault;
  }

  CartFault otherSpeed() {
    const double factor = whole(2) == 0 ? real(0.3, 0.7) : real(1.4, 2.0);
    CartFault fault = withRobot(
        "arm " + std::to_string(factor) + " times as fast", [=](SimulatedCart& cart) { cart.gain *= factor; },
        [=](SimulatedCart& cart) { cart.gain /= factor; });
    fault.faster = std::max(1.0, factor);
    return fault;
  }

  CartFault later() {
    const double lag = real(0.05, 0.4);
    CartFault fault = withRobot(
        "arm " + std::to_string(lag) + " s later", [=](SimulatedCart& cart) { cart.lag += lag; },
        [=](SimulatedCart& cart) { cart.lag -= lag; });
    fault.later = lag;
    return fault;
  }

  CartFault motionOfAnother() {
    const scope::Velocity velocity{sign() * real(0.0, 0.1), sign() * real(0.0, 0.1), sign() * real(0.0, 0.1), 0.0};
    return withInput("says another arm's motion",
                     [velocity](servo::ControllerInput& input) { input.robot_report.velocity = velocity; });
  }
};

}  // namespace laparoscope_servo::test
