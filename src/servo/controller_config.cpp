#include "laparoscope_servo/servo/controller_config.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "laparoscope_servo/validation/range_checker.h"

namespace laparoscope_servo::servo {

namespace {

class Checker : public validation::RangeChecker {
 public:
  using RangeChecker::range;

  // `angular` bounds pan, tilt and spin, `linear` bounds insertion.
  void range(const std::string& group, const scope::Velocity& value, double minimum, double angular, double linear,
             const std::string& derivative) {
    range(group + "/pan", value.pan, minimum, angular, "rad/" + derivative);
    range(group + "/tilt", value.tilt, minimum, angular, "rad/" + derivative);
    range(group + "/spin", value.spin, minimum, angular, "rad/" + derivative);
    range(group + "/insertion", value.insertion, minimum, linear, "m/" + derivative);
  }

  void atLeast(const std::string& name, double value, const std::string& other_name, double other) {
    if (!(value < other)) return;
    std::ostringstream error;
    error << name << " = " << value << ", expected at least " << other_name << " = " << other;
    add(error.str());
  }
};

void checkDeadZone(const DeadZoneConfig& config, Checker& check) {
  check.range("dead_zone/width", config.width, 0.0, 0.1, 0.02, "s");
}

void checkLaws(const ControllerConfig& config, Checker& check) {
  // No negative gain: it would drive the arm away from the target.
  check.range("gains/pan", config.gains.pan, 0.0, 5.0, "1/s");
  check.range("gains/tilt", config.gains.tilt, 0.0, 5.0, "1/s");
  check.range("gains/spin", config.gains.spin, 0.0, 5.0, "1/s");
  check.range("gains/insertion", config.gains.insertion, 0.0, 0.5, "m/s");
  check.range("features/centre", config.features.centre, 0.0, 20.0, "1/s");
  check.range("features/depth", config.features.depth, 0.0, 20.0, "1/s");
  check.range("features/orientation", config.features.orientation, 0.0, 20.0, "1/s");
  check.range("features/desired_depth", config.features.desired_depth, 0.005, 0.5, "m");
  const PredictorConfig& predictor = config.predictor;
  check.range("predictor/min_delay", predictor.min_delay, 0.0, 1.0, "s");
  check.range("predictor/max_delay", predictor.max_delay, 0.0, 1.0, "s");
  check.atLeast("predictor/max_delay", predictor.max_delay, "predictor/min_delay", predictor.min_delay);
  check.range("predictor/delay", predictor.delay, std::max(0.0, predictor.min_delay),
              std::min(1.0, predictor.max_delay), "s");
  check.range("predictor/command_lifetime", predictor.command_lifetime, 0.02, 2.0, "s");
}

void checkTarget(const TargetMotionConfig& config, Checker& check) {
  // Not zero: without noise of its own a filter stops listening.
  check.range("target/centre_noise", config.centre_noise, 1e-6, 1.0);
  check.range("target/depth_noise", config.depth_noise, 1e-6, 1.0);
  check.range("target/orientation_noise", config.orientation_noise, 1e-6, 1.0, "rad");
  check.range("target/centre_wander", config.centre_wander, 1e-6, 1.0, "1/sqrt(s)");
  check.range("target/depth_wander", config.depth_wander, 1e-6, 1.0, "1/sqrt(s)");
  check.range("target/orientation_wander", config.orientation_wander, 1e-6, 1.0, "rad/sqrt(s)");
  check.range("target/centre_acceleration", config.centre_acceleration, 0.0, 10.0, "1/s/sqrt(s)");
  check.range("target/depth_acceleration", config.depth_acceleration, 0.0, 10.0, "1/s/sqrt(s)");
  check.range("target/orientation_acceleration", config.orientation_acceleration, 0.0, 10.0, "rad/s/sqrt(s)");
  check.range("target/calibration", config.calibration, 0.0, 2.0);
  check.range("target/significance", config.significance, 0.0, 100.0);
  check.range("target/jump", config.jump, 3.0, 1000.0);
  check.range("target/damping", config.damping, 0.0, 10.0, "1/s");
}

void checkBreathing(const BreathingConfig& config, Checker& check) {
  check.range("breathing/rate_stddev", config.rate_stddev, 0.0, 0.1, "Hz");
  check.range("breathing/min_rate", config.filter.min_frequency, 0.02, 2.0, "Hz");
  check.range("breathing/max_rate", config.filter.max_frequency, 0.02, 2.0, "Hz");
  check.atLeast("breathing/max_rate", config.filter.max_frequency, "breathing/min_rate", config.filter.min_frequency);
  if (config.rate != 0.0) {
    check.range("breathing/rate", config.rate, std::max(0.02, config.filter.min_frequency),
                std::min(2.0, config.filter.max_frequency), "Hz");
  }
  if (check.errors().empty()) {
    for (const std::string& error : validate(config.filter)) check.add("breathing/filter: " + error);
  }
}

void checkDirection(const std::string& name, const std::vector<double>& v, Checker& check) {
  if (v.size() == 3 && Eigen::Vector3d(v[0], v[1], v[2]).norm() > 0.0 && Eigen::Vector3d(v[0], v[1], v[2]).allFinite())
    return;
  check.add(name + " is no direction, expected three finite numbers that are not all zero");
}

void checkRange(const Workspace& range, Checker& check) {
  check.range("range/min_depth", range.min_depth, 0.005, 0.5, "m");
  check.range("range/max_depth", range.max_depth, 0.005, 0.5, "m");
  check.atLeast("range/max_depth", range.max_depth, "range/min_depth", range.min_depth);
  check.range("range/depth_margin", range.depth_margin, 0.0, 0.1, "m");
  check.range("range/cone", range.cone, 0.0, 3.2, "rad");
  check.range("range/cone_margin", range.cone_margin, 0.0, 1.6, "rad");
  checkDirection("range/axis", range.axis, check);
}

void checkInsertionPoint(const InsertionPointUse& config, Checker& check) {
  check.range("insertion_point/prior_stddev", config.prior_stddev, 0.0, 1.0, "m");
  check.range("insertion_point/correction_rate", config.correction_rate, 0.0, 0.1, "m/s");
  for (const std::string& error : validate(config.estimator)) check.add("insertion_point/" + error);
}

void checkEffect(const EffectConfig& config, Checker& check) {
  // Not zero: tissue that cannot move by itself would make a fault of every breath.
  check.range("effect/tissue_centre", config.tissue_centre, 1e-3, 10.0, "1/s");
  check.range("effect/tissue_depth", config.tissue_depth, 1e-3, 10.0, "1/s");
  check.range("effect/tissue_orientation", config.tissue_orientation, 1e-3, 10.0, "rad/s");
  check.range("effect/tissue_time", config.tissue_time, 0.05, 60.0, "s");
  check.range("effect/unrest_time", config.unrest_time, 0.0, 10.0, "s");
  check.range("effect/memory", config.memory, 0.1, 60.0, "s");
  check.range("effect/doubt", config.doubt, 1.0, 100.0);
  check.range("effect/release", config.release, 0.0, 100.0);
  check.atLeast("effect/doubt", config.doubt, "effect/release", config.release);
  check.range("effect/certain", config.certain, 1.0, 1000.0);
  check.atLeast("effect/certain", config.certain, "effect/doubt", config.doubt);
  check.range("effect/standing_time", config.standing_time, 0.05, 10.0, "s");
  check.range("effect/unconfirmed_turn", config.unconfirmed_turn, 1e-3, 10.0, "rad");
  check.range("effect/unconfirmed_insertion", config.unconfirmed_insertion, 1e-4, 1.0, "m");
}

void checkOscillation(const OscillationConfig& config, Checker& check) {
  check.range("oscillation/half_period", config.half_period, 0.05, 5.0, "s");
  check.range("oscillation/changes", config.changes, 1, 100);
  check.range("oscillation/centre", config.centre, 0.0, 1.0);
  check.range("oscillation/depth", config.depth, 0.0, 1.0);
  check.range("oscillation/orientation", config.orientation, 0.0, 3.2, "rad");
  check.range("oscillation/step", config.step, 0.1, 1.0);
  check.range("oscillation/least", config.least, 0.01, 1.0);
}

void checkRest(const RestConfig& config, Checker& check) {
  check.range("rest/centre_stop", config.centre_stop, 0.0, 0.1);
  check.range("rest/centre_start", config.centre_start, 0.0, 0.1);
  check.range("rest/depth_stop", config.depth_stop, 0.0, 0.1);
  check.range("rest/depth_start", config.depth_start, 0.0, 0.1);
  check.range("rest/orientation_stop", config.orientation_stop, 0.0, 0.1, "rad");
  check.range("rest/orientation_start", config.orientation_start, 0.0, 0.1, "rad");
  check.range("rest/hunting_time", config.hunting_time, 0.0, 10.0, "s");
  check.range("rest/widening", config.widening, 1.0, 3.0);
  check.range("rest/widest", config.widest, 1.0, 10.0);
  check.atLeast("rest/centre_start", config.centre_start, "rest/centre_stop", config.centre_stop);
  check.atLeast("rest/depth_start", config.depth_start, "rest/depth_stop", config.depth_stop);
  check.atLeast("rest/orientation_start", config.orientation_start, "rest/orientation_stop", config.orientation_stop);
}

void checkSafety(const SafetyConfig& config, Checker& check) {
  check.range("safety/max_task_error_age", config.max_task_error_age, 0.01, 1.0, "s");
  check.range("safety/max_depth_age", config.max_depth_age, 0.01, 1.0, "s");
  check.range("safety/min_depth", config.min_depth, 0.005, 0.5, "m");
  check.range("safety/max_depth", config.max_depth, 0.005, 0.5, "m");
  check.atLeast("safety/max_depth", config.max_depth, "safety/min_depth", config.min_depth);
  check.range("safety/max_lateral_offset", config.max_lateral_offset, 0.0, 0.1, "m");
  check.range("safety/max_tip_speed", config.max_tip_speed, 0.01, 1000.0, "m/s");
  check.range("safety/max_tip_turn", config.max_tip_turn, 0.05, 1000.0, "rad/s");
  check.range("safety/max_optics_offset", config.max_optics_offset, 0.0, 1.0, "m");
  check.range("safety/resume_time", config.resume_time, 0.0, 10.0, "s");
  check.range("safety/max_period", config.max_period, 0.001, 1.0, "s");
  check.range("safety/max_clock_step", config.max_clock_step, 0.01, 10.0, "s");
  check.atLeast("safety/max_clock_step", config.max_clock_step, "safety/max_period", config.max_period);
  check.range("safety/slow_below", config.slow_below, 0.0, 1.0);
  check.range("safety/hold_below", config.hold_below, 0.0, 1.0);
  check.atLeast("safety/slow_below", config.slow_below, "safety/hold_below", config.hold_below);
  check.range("safety/release_hold_above", config.release_hold_above, 0.0, 1.0);
  check.atLeast("safety/release_hold_above", config.release_hold_above, "safety/hold_below", config.hold_below);
  check.range("safety/min_visible_for_insertion", config.min_visible_for_insertion, 0.0, 1.0);
  check.range("safety/max_corner_error_for_insertion", config.max_corner_error_for_insertion, 0.0, 100.0, "px");
  check.range("safety/max_dead_man_age", config.max_dead_man_age, 0.01, 1.0, "s");
  check.range("safety/max_robot_state_age", config.max_robot_state_age, 0.01, 2.0, "s");
  check.range("safety/max_manual_age", config.max_manual_age, 0.01, 1.0, "s");
  check.range("safety/max_manual_repeat", config.max_manual_repeat, 0.5, 3600.0, "s");
  check.range("safety/manual_neutral", config.manual_neutral, 0.0, 0.5);
  check.range("safety/max_repeated_errors", config.max_repeated_errors, 1, 100);
  check.range("safety/max_clock_difference", config.max_clock_difference, 0.001, 1.0, "s");
}

}  // namespace

std::vector<std::string> validate(const ControllerConfig& config) {
  Checker check;
  checkLaws(config, check);
  checkTarget(config.target, check);
  checkBreathing(config.breathing, check);
  checkOscillation(config.oscillation, check);
  checkEffect(config.effect, check);
  checkRange(config.range, check);
  checkInsertionPoint(config.insertion_point, check);
  checkDirection("horizon/up", config.horizon.up, check);
  checkDeadZone(config.dead_zone, check);
  checkRest(config.rest, check);
  // Not zero: since all components are scaled together, it would stop the others too. A gain of zero keeps one still.
  check.range("limits/velocity", config.limits.velocity, 1e-6, 1.0, 0.1, "s");
  // The dead zone's inverse stays within the limits.
  const Eigen::Vector4d room = config.limits.velocity.vector() - config.dead_zone.width.vector();
  if (config.dead_zone.inverse && !(room.array() > 0.0).all()) {
    check.add("limits/velocity is not above dead_zone/width, expected more in each component");
  }
  check.range("limits/acceleration", config.limits.acceleration, 1e-6, 100.0, 10.0, "s^2");
  checkSafety(config.safety, check);
  return check.errors();
}

}  // namespace laparoscope_servo::servo
