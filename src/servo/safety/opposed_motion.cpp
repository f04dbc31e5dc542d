#include "servo/safety/opposed_motion.h"

#include <cmath>

namespace laparoscope_servo::servo {

namespace {

const char* const kAxes[] = {"pan", "tilt", "spin", "insertion"};
constexpr double kLate = 0.1;    // s, by which the robot may be later than its delay; the effect guard allows 0.14 s
constexpr double kLasts = 0.15;  // s, least time for which an axis must move in the wrong direction, in all
// s, the same where it is told to go fast, and has been for longer than any robot is late: before a robot turns round
// it is told to slow down, by limits/acceleration for 0.06 s. Three reports at 40 Hz, so that two that are wrong do not
// do.
constexpr double kFastLasts = 0.04;
constexpr double kFast = 10.0;  // times the dead zone: 0.04 rad/s, 4 mm/s
constexpr double kStep = 0.02;  // s, between the commands that are compared: the period of commands at 50 Hz

enum class Sense { kWith, kAgainst, kFastAgainst, kUnclear };

// Of the motion, by the commands since before its delay. Rest counts for nothing: the scope may have been held
// meanwhile.
Sense senseOf(double time, double done, const CommandHistory& told, double delay, int axis, double width) {
  if (told.velocity(time, delay)[axis] * done > 0.0) return Sense::kWith;
  bool against = false, fast = std::abs(done) > kFast * width;
  for (double age = 0.0; age <= delay + kLate; age += kStep) {
    const double command = told.velocity(time, age)[axis];
    if (command * done > 0.0) return Sense::kUnclear;
    against |= command * done < 0.0;
    fast &= std::abs(command) > kFast * width;
  }
  return !against ? Sense::kUnclear : fast ? Sense::kFastAgainst : Sense::kAgainst;
}

}  // namespace

void OpposedMotion::restart() {
  opposed_.fill(false);
  opposed_for_.fill(0.0);
  words_.clear();
}

void OpposedMotion::report(double time, const scope::Velocity& done, const CommandHistory& told, double delay) {
  const Eigen::Vector4d velocity = done.vector();
  if (!words_.empty() || !velocity.allFinite() || !std::isfinite(time)) return;
  const double step = time - last_time_;
  const bool goes_on = step > 0.0 && step < 2.0 * kLasts;
  last_time_ = time;
  for (int k = 0; k < 4; ++k) {
    const double width = width_.vector()[k];
    const bool moves = std::abs(velocity[k]) > 2.0 * width;
    const Sense sense = moves ? senseOf(time, velocity[k], told, delay, k, width) : Sense::kUnclear;
    const bool fast = sense == Sense::kFastAgainst;
    const bool opposed = sense == Sense::kAgainst || fast;
    if (sense == Sense::kWith) opposed_for_[k] = 0.0;
    if (opposed && opposed_[k] && goes_on) opposed_for_[k] += step;
    opposed_[k] = opposed;
    if (opposed_for_[k] > (fast ? kFastLasts : kLasts))
      words_ = std::string("the robot says that its ") + kAxes[k] + " goes against what it is told";
  }
}

}  // namespace laparoscope_servo::servo
