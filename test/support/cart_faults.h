// Faults of what the controller is told, and of the robot, at random: what they are, and what the scope may do
// meanwhile.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "support/cart_source_faults.h"

namespace laparoscope_servo::test {

class RandomCartFaults : public CartSourceFaults {
 public:
  using CartSourceFaults::CartSourceFaults;

  // Two faults that begin within 0.6 s of `now` and last for 0.3 to 2.5 s. `manual`: the task is MANUAL. Two mirrors
  // make a true picture, and who judges an effect has to know it. `strangers`: the first is one of a stranger.
  std::vector<CartFault> pair(double now, bool manual, bool strangers) {
    std::vector<CartFault> faults{strangers ? ofStranger(manual) : one(manual)};
    faults.push_back(one(manual));
    const auto clash = [](const CartFault& a, const CartFault& b) {
      return a.of_picture && (b.of_picture || b.blinds);
    };
    while (clash(faults[0], faults[1]) || clash(faults[1], faults[0])) faults[1] = one(manual);
    for (CartFault& fault : faults) {
      fault.from = now + real(0.0, 0.6);
      fault.until = fault.from + real(0.3, 2.5);
    }
    return faults;
  }

 private:
  using Input = servo::ControllerInput;
  using Maker = CartFault (RandomCartFaults::*)();

  CartFault one(bool manual) {
    static const std::vector<Maker> kinds{
        &RandomCartFaults::ofPicture, &RandomCartFaults::ofPicture, &RandomCartFaults::ofTracker,
        &RandomCartFaults::ofTracker, &RandomCartFaults::ofRobot,   &RandomCartFaults::ofPose,
        &RandomCartFaults::ofDeadMan, &RandomCartFaults::ofTime,    &RandomCartFaults::ofSource,
        &RandomCartFaults::ofArm,     &RandomCartFaults::ofManual};
    const bool of_manual = manual && whole(3) == 0;
    const int kind = of_manual ? 10 : whole(10);
    CartFault fault = (this->*kinds[static_cast<std::size_t>(kind)])();
    fault.of_picture = kind < 2;
    if (manual && kind < 4) fault.stops = false;  // nothing that comes from a camera counts
    return fault;
  }

  double nonsense() {
    static const double values[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                                    -std::numeric_limits<double>::infinity()};
    return values[whole(3)];
  }

  // What is seen is not what is there. Old pictures in turn are the tracker's to notice.
  CartFault ofPicture() {
    switch (whole(6)) {
      case 0:
      case 5: {
        // A grabber digitises even a still picture anew each time.
        const double noise = whole(2) == 0 ? 0.0 : 0.3 / kFocalLength;
        const auto first = std::make_shared<std::vector<servo::TaskErrorInput>>();
        const auto random = std::make_shared<std::mt19937>(static_cast<unsigned>(whole(1000000)));
        return withTracker(noise > 0.0 ? "frozen, with noise" : "frozen", [=](servo::TaskErrorInput& seen) {
          if (first->empty()) first->push_back(seen);
          seen = first->front();
          if (!(noise > 0.0)) return;
          std::normal_distribution<double> normal(0.0, noise);
          const double x = normal(*random);
          shift(seen, x, normal(*random));
          for (double* value : {&seen.error.log_depth, &seen.error.alpha}) *value += normal(*random);
        });
      }
      case 1:
        return withPicture("mirrored x", Eigen::Vector3d(-1.0, 1.0, 1.0).asDiagonal());
      case 2:
        return withPicture("mirrored y", Eigen::Vector3d(1.0, -1.0, 1.0).asDiagonal());
      case 3: {
        const double roll = sign() * real(60.0, 180.0);
        const Eigen::Matrix3d turn = geometry::so3Exp({0.0, 0.0, roll * M_PI / 180.0});
        return withPicture("rolled by " + std::to_string(std::lround(roll)) + " degrees", turn);
      }
      default: {
        const Eigen::Matrix3d turn = geometry::so3Exp({0.0, 0.0, M_PI});
        return withInput("shaft frame turned by 180 degrees",
                         [turn](Input& input) { input.depth.camera_R_shaft = turn * input.depth.camera_R_shaft; });
      }
    }
  }

  CartFault ofTracker() {
    switch (whole(12)) {
      case 0: {
        const auto first = std::make_shared<std::vector<servo::TaskErrorInput>>();
        const auto since = std::make_shared<double>(0.0);
        return withInput("tracker silent", [first, since](Input& input, double time) {
          if (first->empty()) {
            first->push_back(input.task_error);
            *since = time;
          }
          input.task_error = first->front();
          input.task_error.age += time - *since;
          input.task_error.image_age += time - *since;
        });
      }
      case 1:
        return withTracker("not valid", [](servo::TaskErrorInput& seen) { seen.valid = false; });
      case 2: {
        const double value = nonsense();
        const int member = whole(4);
        return withTracker("feature " + std::to_string(member) + " is " + std::to_string(value),
                           [=](servo::TaskErrorInput& seen) { feature(seen, member) = value; });
      }
      case 3:
        return withInput("stamped in the future", [](Input& input) { input.task_error.problem = "of the future"; });
      case 4: {
        const double age = sign() * real(0.3, 5.0);
        return withInput("image's age " + std::to_string(age), [age](Input& input) {
          input.task_error.image_age = age;
          input.task_error.image_time = input.time - age;
        });
      }
      case 5:
        return withTracker("covered", [](servo::TaskErrorInput& seen) { seen.visible_fraction = 0.1; });
      case 6:
        return bearable(withTracker("half covered", [](servo::TaskErrorInput& seen) {
          seen.visible_fraction = std::min(seen.visible_fraction, 0.35);
        }));
      case 7:
        return blinding(withTracker("corners unknown", [](servo::TaskErrorInput& seen) {
          seen.corner_error = std::numeric_limits<double>::infinity();
        }));
      case 8: {
        const auto count = std::make_shared<int>(0);
        return bearable(withTracker("valid now and then",
                                    [count](servo::TaskErrorInput& seen) { seen.valid = ++*count % 2 == 0; }));
      }
      case 9: {
        const auto last = std::make_shared<servo::TaskErrorInput>();
        const auto count = std::make_shared<int>(0);
        const int every = 2 + whole(49);
        return bearable(withTracker("1 in " + std::to_string(every) + " dropped", [=](servo::TaskErrorInput& seen) {
          if (++*count % every == 0) seen.valid = false;
        }));
      }
      case 10:
        return withTracker("visible fraction is no number", [](servo::TaskErrorInput& seen) {
          seen.visible_fraction = std::numeric_limits<double>::quiet_NaN();
        });
      default:
        return bearable(withTracker("another region", [](servo::TaskErrorInput& seen) { seen.region = 2.0; }));
    }
  }

  static double& feature(servo::TaskErrorInput& seen, int member) {
    double* const members[] = {&seen.error.x, &seen.error.y, &seen.error.log_depth, &seen.error.alpha};
    return *members[member];
  }

  CartFault ofRobot() {
    switch (whole(6)) {
      case 0:
      case 1: {
        CartFault fault;
        fault.name = "robot disabled";
        fault.begin = [](SimulatedCart& cart) { ++cart.disabled; };
        fault.end = [](SimulatedCart& cart) { --cart.disabled; };
        return forSomebody(fault);
      }
      case 2:
        return withInput("robot's state unknown", [](Input& input) { input.robot.problem = "no state"; });
      case 3: {
        const double age = whole(2) == 0 ? nonsense() : real(0.6, 10.0);
        return withInput("robot's state " + std::to_string(age) + " s old",
                         [age](Input& input) { input.robot.age = age; });
      }
      case 4: {
        const double value = nonsense();
        return bearable(withInput("robot's velocity " + std::to_string(value),
                                  [value](Input& input) { input.robot_report.velocity.pan = value; }));
      }
      default:
        return bearable(withInput("robot's velocity has the wrong sign", [](Input& input) {
          input.robot_report.velocity = scope::Velocity::fromVector(-input.robot_report.velocity.vector());
        }));
    }
  }

  CartFault ofPose() {
    switch (whole(5)) {
      case 0: {
        const double d2 = whole(2) == 0 ? nonsense() : real(0.26, 100.0) * sign();
        return withInput("d2 = " + std::to_string(d2), [d2](Input& input) { input.depth.d2 = d2; });
      }
      case 1:
        return withInput("no pose", [](Input& input) { input.depth = servo::DepthInput(); });
      case 2: {
        const double age = whole(2) == 0 ? nonsense() : sign() * real(0.3, 10.0);
        return withInput("pose " + std::to_string(age) + " s old", [age](Input& input) { input.depth.age = age; });
      }
      case 3:
        return forSomebody(
            withInput("shaft beside the insertion point", [](Input& input) { input.depth.lateral_offset = 0.03; }));
      default:
        return forSomebody(withInput("lateral offset is no number", [](Input& input) {
          input.depth.lateral_offset = std::numeric_limits<double>::quiet_NaN();
        }));
    }
  }

  CartFault ofDeadMan() {
    switch (whole(3)) {
      case 0:
        return withInput("dead-man switch released", [](Input& input) { input.dead_man.pressed = false; });
      case 1: {
        const double age = whole(2) == 0 ? nonsense() : sign() * real(0.25, 10.0);
        return withInput("dead-man switch " + std::to_string(age) + " s old",
                         [age](Input& input) { input.dead_man.age = age; });
      }
      default: {
        const auto count = std::make_shared<int>(0);
        return bearable(withInput("dead-man switch flickers",
                                  [count](Input& input) { input.dead_man.pressed &= ++*count / 3 % 2 == 0; }));
      }
    }
  }

  CartFault ofTime() {
    switch (whole(3)) {
      case 0:
        return forSomebody(withInput("ROS time jumped", [](Input& input) { input.clock_jump = "ROS time jumped"; }));
      case 1: {
        const double jump = sign() * real(1.1, 100.0);
        return forSomebody(withInput("steady clock jumped by " + std::to_string(jump), [jump](Input& input) {
          input.time += jump;
          if (input.task_error.image_time) *input.task_error.image_time += jump;
        }));
      }
      default: {
        CartFault fault;
        fault.name = "controller stalls";
        fault.begin = [](SimulatedCart& cart) { ++cart.controller_stalls; };
        fault.end = [](SimulatedCart& cart) { --cart.controller_stalls; };
        return fault;
      }
    }
  }

  CartFault ofManual() {
    const double value = nonsense();
    if (whole(2) == 0) {
      return withInput("manual command " + std::to_string(value),
                       [value](Input& input) { input.manual.velocity.tilt = value; });
    }
    const double age = whole(2) == 0 ? value : sign() * real(0.25, 10.0);
    return withInput("manual command " + std::to_string(age) + " s old",
                     [age](Input& input) { input.manual.age = age; });
  }
};

}  // namespace laparoscope_servo::test
