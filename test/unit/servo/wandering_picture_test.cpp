// Pictures that run through, are zoomed or turned while the scope follows them look like tissue, or like a hand, that
// moves: how far the scope goes along, in simulated time. WANDERING_VERBOSE prints it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <string>

#include "laparoscope_servo/servo/place_error.h"
#include "support/simulated_cart.h"

namespace laparoscope_servo::servo {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kImage = 0.04;   // s, from one picture to the next
constexpr double kFocal = 400.0;  // px, of the simulated cart

struct Followed {
  std::string state, reason;
  test::ScopeTravel travel;  // since the fault
  double time = 0.0;         // s, from the fault until the scope stands for good
};

using Picture = std::function<Eigen::Matrix3d(double)>;  // by the seconds since the fault

Picture running(double right, double down) {  // px an image
  return [=](double t) {
    Eigen::Matrix3d change = Eigen::Matrix3d::Identity();
    change(0, 2) = right / kFocal * t / kImage;
    change(1, 2) = down / kFocal * t / kImage;
    return change;
  };
}

Picture zoomed(double rate, double most) {
  return [=](double t) {
    const double scale = most > 1.0 ? std::min(std::pow(rate, t), most) : std::max(std::pow(rate, -t), most);
    return Eigen::Matrix3d(Eigen::Vector3d(scale, scale, 1.0).asDiagonal());
  };
}

Picture turned(double rate, double most) {  // degrees a second
  return [=](double t) { return geometry::so3Exp({0.0, 0.0, std::min(rate * t, most) * kDegree}); };
}

// What the region's tracker sees is the input of each task: the region is the view, its centre the tip.
void giveEachTask(ControllerInput& input, double) {
  input.view = input.tip = input.task_error;
  input.tip.error = placeError({input.task_error.error.x, input.task_error.error.y}, {0.0, 0.0});
}

struct Case {
  Task task = Task::kHoldView;
  scope::Velocity start;  // rad, m
  double after = 0.0;     // s, from engaging to the fault
};

Followed follow(const Picture& picture, const Case& c, unsigned seed) {
  test::SimulatedCart cart(ControllerConfig(), c.start, seed);
  cart.interference.input = giveEachTask;
  cart.controller.select(c.task);
  cart.pass(1.0);
  EXPECT_EQ(cart.controller.engage(cart.input()), "");
  cart.pass(c.after);
  EXPECT_EQ(cart.output.state, ControllerState::kServo) << cart.output.reason;
  const double begin = cart.time();
  const Eigen::Isometry3d from = cart.pose();
  cart.interference.picture = [&](Eigen::Matrix3d& h) { h = picture(cart.time() - begin) * h; };
  Followed followed;
  while (cart.time() < begin + 15.0) {
    cart.step();
    const test::ScopeTravel travel = cart.travel(from);
    followed.travel.angle = std::max(followed.travel.angle, travel.angle);
    followed.travel.distance = std::max(followed.travel.distance, travel.distance);
    if (!cart.velocity().isZero(0.0)) followed.time = cart.time() - begin;
  }
  followed.state = name(cart.output.state);
  followed.reason = cart.output.reason;
  return followed;
}

struct Row {
  std::string name;
  Picture picture;
  // Allowed where the view was reached, and on the way to it: degrees, mm. Measured, and a little more.
  test::ScopeTravel reached, on_the_way;
};

std::vector<Row> rows() {
  return {
      {"running down by 2 px", running(0.0, 2.0), {9.4, 4.1}, {11.9, 6.1}},
      {"running up by 3 px", running(0.0, -3.0), {9.4, 4.1}, {13.6, 7.8}},
      {"running to the right by 3 px", running(3.0, 0.0), {9.4, 4.1}, {8.0, 4.7}},
      {"running to the right by 1 px", running(1.0, 0.0), {9.4, 4.1}, {6.6, 4.4}},
      {"zoomed in by 1.3 a second", zoomed(1.3, 2.0), {0.3, 4.3}, {3.3, 3.0}},
      {"zoomed out by 1.3 a second", zoomed(1.3, 0.5), {0.3, 4.3}, {3.3, 3.0}},
      {"zoomed in by 1.1 a second", zoomed(1.1, 2.0), {0.3, 9.0}, {3.6, 6.0}},
      {"zoomed out by 1.1 a second", zoomed(1.1, 0.5), {0.3, 9.0}, {3.6, 6.0}},
      {"turned by 20 degrees a second", turned(20.0, 150.0), {1.4, 0.2}, {3.1, 1.0}},
      {"turned by 5 degrees a second", turned(5.0, 150.0), {5.6, 0.5}, {7.2, 1.0}},
      {"turned by 90 degrees a second", turned(90.0, 150.0), {0.3, 0.2}, {1.8, 1.0}},
  };
}

void expectBounded(const Row& row, const test::ScopeTravel& allowed, const Case& c) {
  Followed worst;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Followed followed = follow(row.picture, c, seed);
    SCOPED_TRACE(row.name + ", seed " + std::to_string(seed) + ": " + followed.reason);
    EXPECT_TRUE(followed.state == "LOST" || followed.state == "FAULT") << followed.state;
    EXPECT_LE(followed.travel.angle / kDegree, allowed.angle);
    EXPECT_LE(1e3 * followed.travel.distance, allowed.distance);
    worst.reason = followed.reason;
    worst.travel.angle = std::max(worst.travel.angle, followed.travel.angle);
    worst.travel.distance = std::max(worst.travel.distance, followed.travel.distance);
    worst.time = std::max(worst.time, followed.time);
  }
  if (std::getenv("WANDERING_VERBOSE") == nullptr) return;
  std::cout << row.name << ", " << c.after << " s: " << worst.travel.angle / kDegree << " deg, "
            << 1e3 * worst.travel.distance << " mm, " << worst.time << " s, " << worst.reason << std::endl;
}

TEST(WanderingPicture, IsFollowedOnlySoFarWhereTheViewWasReached) {
  for (const Row& row : rows()) expectBounded(row, row.reached, {Task::kHoldView, {0.05, 0.02, 0.05, 0.004}, 8.0});
}

// What the scope had to go anyway, some 3 degrees of pan, is in it.
TEST(WanderingPicture, IsFollowedOnlySoFarOnTheWay) {
  for (const Row& row : rows()) expectBounded(row, row.on_the_way, {Task::kHoldView, {0.15, 0.0, 0.0, 0.0}, 1.2});
}

std::vector<Row> runningRows() {
  std::vector<Row> all = rows();
  all.resize(4);
  return all;
}

TEST(WanderingPicture, ThatRunsIsFollowedOnlySoFarInStabilise) {
  for (const Row& row : runningRows()) expectBounded(row, {9.4, 1e-6}, {Task::kStabilise, {0.05, 0.02, 0.0, 0.0}, 8.0});
}

// Spin and insertion are not used: what would be followed by them takes the scope nowhere, and is no reason to stop.
TEST(WanderingPicture, ThatIsZoomedOrTurnedChangesNothingInStabilise) {
  for (const Row& row : rows()) {
    if (row.name.find("running") != std::string::npos) continue;
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const Followed followed = follow(row.picture, {Task::kStabilise, {0.05, 0.02, 0.0, 0.0}, 8.0}, seed);
      EXPECT_EQ(followed.state, "SERVO") << followed.reason;
      EXPECT_LT(followed.travel.angle / kDegree, 0.1) << row.name << ", seed " << seed;
      EXPECT_LT(followed.travel.distance, 1e-9) << row.name << ", seed " << seed;
    }
  }
}

// A loop that never comes up with it would go on for ever: 21.9 degrees by 2.8 px an image, without a leash. Where the
// picture runs as slowly as a hand that is still, it is followed, as that hand is.
TEST(WanderingPicture, ThatRunsIsFollowedOnlySoFarOnTheWayToATip) {
  for (const double right : {-3.0, -2.8, -2.4, -1.0, 1.0, 3.0}) {
    const std::string name = "running to the right by " + std::to_string(right) + " px";
    expectBounded({name, running(right, 0.0), {}, {}}, {16.3, 1e-6}, {Task::kCentreTip, {0.15, 0.0, 0.0, 0.0}, 0.3});
  }
}

// A hand takes the tip 80 px further to the left every 5 s: more than the leash in all, less each time.
TEST(WanderingPicture, IsFollowedAnywhereWhereAHandHoldsTheTipStill) {
  const Picture by_hand = [](double t) {
    Eigen::Matrix3d change = Eigen::Matrix3d::Identity();
    change(0, 2) = -80.0 / kFocal * std::min(1.0 + std::floor(t / 5.0), 3.0);
    return change;
  };
  const Followed followed = follow(by_hand, {Task::kCentreTip, scope::Velocity(), 1.0}, 1);
  EXPECT_EQ(followed.state, "SERVO") << followed.reason;
  EXPECT_GT(followed.travel.angle, 1.3 * LeashConfig().turn);
}

}  // namespace
}  // namespace laparoscope_servo::servo
