#include "laparoscope_servo/servo/task_error_input.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "unit/servo/controller_input.h"
#include "unit/servo/plane_loop.h"

namespace laparoscope_servo::servo {
namespace {

using test::kInfinity;
using test::kNan;

TaskErrorInput good() {
  return test::good(0.0).task_error;
}

TEST(TaskErrorInput, WhatATrackerSaysIsPlausible) {
  EXPECT_EQ(implausible(good()), "");
  TaskErrorInput input = good();
  input.corner_error = kInfinity;  // unknown
  input.visible_fraction = 0.0;
  input.error.alpha = M_PI;
  input.error.log_depth = -2.9;
  EXPECT_EQ(implausible(input), "");
  // Whatever part of the image the scope turns to.
  for (const double pan : {-1.0, -0.3, 0.0, 0.3, 1.0}) {
    for (const double spin : {-3.0, 0.0, 3.0}) {
      test::PlaneLoop loop(Eigen::Vector3d::UnitZ(), test::kZ, test::straight());
      loop.offset({0.3 * pan, -0.2 * pan, spin, 0.03 * pan});
      input = good();
      input.error = loop.error();
      EXPECT_EQ(implausible(input), "") << pan << ' ' << spin;
    }
  }
}

TEST(TaskErrorInput, EachNumberHasItsRange) {
  struct Case {
    const char* words;
    std::function<void(TaskErrorInput&, double)> set;
    std::vector<double> bad;
  };
  const std::vector<Case> cases{
      {"x or y", [](TaskErrorInput& i, double v) { i.error.x = v; }, {5.1, -5.1, 1e300}},
      {"x or y", [](TaskErrorInput& i, double v) { i.error.y = v; }, {5.1, -5.1, 1e300}},
      {"desired_x", [](TaskErrorInput& i, double v) { i.error.desired_x = v; }, {5.1, -1e300}},
      {"desired_y", [](TaskErrorInput& i, double v) { i.error.desired_y = v; }, {5.1, -1e300}},
      {"log_depth", [](TaskErrorInput& i, double v) { i.error.log_depth = v; }, {3.1, -3.1}},
      {"desired_log_depth", [](TaskErrorInput& i, double v) { i.error.desired_log_depth = v; }, {3.1, -3.1}},
      {"alpha", [](TaskErrorInput& i, double v) { i.error.alpha = v; }, {3.15, -3.15}},
      {"desired_alpha", [](TaskErrorInput& i, double v) { i.error.desired_alpha = v; }, {3.15, -3.15}},
      {"m_star", [](TaskErrorInput& i, double v) { i.error.m_star.z() = v; }, {0.0, -1.0, 2.0}},
      {"m_star", [](TaskErrorInput& i, double v) { i.error.m_star.x() = v; }, {6.0, -6.0}},
      {"behind the camera", [](TaskErrorInput& i, double v) { i.error.e_v.z() = v; }, {-1.0, -100.0}},
      {"depth in e_v", [](TaskErrorInput& i, double v) { i.error.e_v.z() = v; }, {-0.999, 100.0}},
      {"e_v", [](TaskErrorInput& i, double v) { i.error.e_v.x() = v; }, {100.0, -1e308}},
      {"e_v", [](TaskErrorInput& i, double v) { i.error.e_v.y() = v; }, {100.0, -1e308}},
      {"visible_fraction", [](TaskErrorInput& i, double v) { i.visible_fraction = v; }, {-0.1, 1.1, kNan}},
      {"corner_error", [](TaskErrorInput& i, double v) { i.corner_error = v; }, {-0.1, -kInfinity, kNan}},
      {"not finite", [](TaskErrorInput& i, double v) { i.error.e_w.y() = v; }, {kNan, kInfinity}},
  };
  for (const Case& one : cases) {
    for (const double bad : one.bad) {
      TaskErrorInput input = good();
      one.set(input, bad);
      EXPECT_NE(implausible(input).find(one.words), std::string::npos) << one.words << ' ' << bad << implausible(input);
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo::servo
