#include "laparoscope_servo/servo/controller_config.h"

#include <algorithm>
#include <utility>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::servo {

namespace {

using parameters::Range;
using parameters::Table;

// `angular` is the range of pan, tilt and spin, `linear` that of insertion; `per` is the denominator of the units.
void describeVelocity(Table& table, scope::Velocity& v, const Range& angular, const Range& linear,
                      const std::string& per) {
  table.number("pan", v.pan, angular, "rad/" + per, "about the insertion point, sideways");
  table.number("tilt", v.tilt, angular, "rad/" + per, "about the insertion point, up and down");
  table.number("spin", v.spin, angular, "rad/" + per, "about the shaft");
  table.number("insertion", v.insertion, linear, "m/" + per, "along the shaft");
}

void describeFeatures(Table& table, FeatureGains& c) {
  table.number("centre", c.centre, {0, 20}, "1/s", "rate at which the error of the region's centre decays")
      .whileRunning();
  table.number("depth", c.depth, {0, 20}, "1/s", "rate at which the error of depth decays").whileRunning();
  table.number("orientation", c.orientation, {0, 20}, "1/s", "rate at which the error of orientation decays")
      .whileRunning();
  table.number(
      "desired_depth", c.desired_depth, {0.005, 0.5}, "m",
      "Z*, from the camera to the tissue at the reference, also for the predictor; wrong by two it still converges");
}

// No negative gain: it would drive the arm away from the target.
void describeGains(Table& table, PaperGains& c) {
  table.number("pan", c.pan, {0, 5}, "1/s", "k_p, which holds the 1/d2 of eq. (11)").whileRunning();
  table.number("tilt", c.tilt, {0, 5}, "1/s", "k_t, which holds the 1/d2 of eq. (11)").whileRunning();
  table.number("spin", c.spin, {0, 5}, "1/s", "k_s").whileRunning();
  table.number("insertion", c.insertion, {0, 0.5}, "m/s", "k_d").whileRunning();
}

void describePredictor(Table& table, PredictorConfig& c) {
  table.flag("enabled", c.enabled, "false: the law gets the task error of the last image as it is");
  table.number("delay", c.delay, {0, 1}, "s", "from a command to its execution, until it is measured")
      .atLeast("min_delay")
      .atMost("max_delay");
  table.flag("measure_delay", c.measure_delay, "the delay is measured from the velocities that the robot reports");
  table.number("min_delay", c.min_delay, {0, 1}, "s", "lower bound of the measured delay");
  table.number("max_delay", c.max_delay, {0, 1}, "s", "upper bound of the measured delay").atLeast("min_delay");
  table.flag("feed_forward", c.feed_forward, "the target's own velocity is added to the law's");
  table.number("command_lifetime", c.command_lifetime, {0.02, 2}, "s",
               "for which the robot executes the last command: command/timeout of the node aesop");
}

// The noises are not zero: a filter without process noise ignores its measurements after a while.
void describeTarget(Table& table, TargetMotionConfig& c) {
  table.number("centre_noise", c.centre_noise, {1e-6, 1}, "px over the focal length",
               "standard deviation of the region's centre in one image");
  table.number("depth_noise", c.depth_noise, {1e-6, 1}, "", "standard deviation of the log depth in one image");
  table.number("orientation_noise", c.orientation_noise, {1e-6, 1}, "rad",
               "standard deviation of the orientation in one image");
  table.number("centre_wander", c.centre_wander, {1e-6, 1}, "1/sqrt(s)",
               "random walk of the centre's place, px over the focal length");
  table.number("depth_wander", c.depth_wander, {1e-6, 1}, "1/sqrt(s)", "random walk of the log depth");
  table.number("orientation_wander", c.orientation_wander, {1e-6, 1}, "rad/sqrt(s)", "random walk of the orientation");
  table.number("centre_acceleration", c.centre_acceleration, {0, 10}, "1/s/sqrt(s)",
               "random walk of the centre's velocity");
  table.number("depth_acceleration", c.depth_acceleration, {0, 10}, "1/s/sqrt(s)",
               "random walk of the log depth's velocity");
  table.number("orientation_acceleration", c.orientation_acceleration, {0, 10}, "rad/s/sqrt(s)",
               "random walk of the orientation's velocity");
  table.number("calibration", c.calibration, {0, 2}, "share", "relative uncertainty of the scope's own motion");
  table
      .number("significance", c.significance, {0, 100}, "standard deviations",
              "from which the target's velocity is used")
      .whileRunning();
  table.number("jump", c.jump, {3, 1000}, "standard deviations", "a larger innovation means another target");
  table.number("damping", c.damping, {0, 10}, "1/s", "decay rate of the target's velocity");
}

void describeBreathing(Table& table, BreathingConfig& c) {
  table.flag("enabled", c.enabled, "periodic motion is followed");
  table.number("rate", c.rate, {0, 2}, "Hz",
               "rate of the ventilator, in [min_rate, max_rate]; 0, or if it proves wrong: the rate is searched");
  table.number("rate_stddev", c.rate_stddev, {0, 0.1}, "Hz", "standard deviation of that rate");
  table.number("min_rate", c.filter.min_frequency, {0.02, 2}, "Hz", "slowest rate of the search");
  table.number("max_rate", c.filter.max_frequency, {0.02, 2}, "Hz", "fastest rate of the search").atLeast("min_rate");
}

void describeRest(Table& table, RestConfig& c) {
  table.flag("enabled", c.enabled, "false: the scope never rests");
  const auto bands = [&](const std::string& name, double& stop, double& start, const std::string& unit,
                         const std::string& what) {
    table.number(name + "_stop", stop, {0, 0.1}, unit, "where the error of " + what + " is less, it stops")
        .whileRunning();
    table.number(name + "_start", start, {0, 0.1}, unit, "where the error of " + what + " is more, it starts")
        .atLeast(name + "_stop")
        .whileRunning();
  };
  bands("centre", c.centre_stop, c.centre_start, "px over the focal length", "the centre");
  bands("depth", c.depth_stop, c.depth_start, "", "the log depth, of which 0.01 is 1 % of scale,");
  bands("orientation", c.orientation_stop, c.orientation_start, "rad", "orientation");
  table.number("hunting_time", c.hunting_time, {0, 10}, "s", "a start within this time after a stop widens the band")
      .whileRunning();
  table.number("widening", c.widening, {1, 3}, "times", "factor by which a band is widened each time").whileRunning();
  table.number("widest", c.widest, {1, 10}, "times", "largest factor on a band's start threshold").whileRunning();
}

void describeOscillation(Table& table, OscillationConfig& c) {
  table.flag("enabled", c.enabled, "false: gains stay as they are");
  table.number("half_period", c.half_period, {0.05, 5}, "s", "changes of sign further apart are no oscillation");
  table.number("changes", c.changes, {1, 100}, "changes",
               "number of changes of sign in a row that make an oscillation");
  table.number("centre", c.centre, {0, 1}, "px over the focal length", "least amplitude to each side");
  table.number("depth", c.depth, {0, 1}, "", "least amplitude of the log depth to each side");
  table.number("orientation", c.orientation, {0, 3.2}, "rad", "least amplitude of the orientation to each side");
  table.number("step", c.step, {0.1, 1}, "times", "factor on the gains for each oscillation");
  table.number("least", c.least, {0.01, 1}, "times", "least factor on the gains");
}

void describeRange(Table& table, Workspace& c) {
  table.number("min_depth", c.min_depth, {0.005, 0.5}, "m", "least d2, of the camera beyond the insertion point");
  table.number("max_depth", c.max_depth, {0.005, 0.5}, "m", "largest d2").atLeast("min_depth");
  table.number("depth_margin", c.depth_margin, {0, 0.1}, "m", "slowed from here to a bound");
  table.numbers("axis", c.axis, 3, Range::finite(), "",
                "direction of the cone's axis in the insertion point's frame, into the body; not all zero");
  table.number("cone", c.cone, {0, 3.2}, "rad", "from the axis to the shaft");
  table.number("cone_margin", c.cone_margin, {0, 1.6}, "rad", "slowed from here to the bound");
}

void describeInsertionPoint(Table& table, InsertionPointUse& c) {
  table.flag("use", c.use, "false: the calibration is taken for true, and nothing watches it");
  table.number("prior_stddev", c.prior_stddev, {0, 1}, "m",
               "standard deviation of the calibration, per axis; 0: it counts for nothing");
  table.number("correction_rate", c.correction_rate, {0, 0.1}, "m/s",
               "at which d2 goes from the calibration's to the estimate's");
  describe(table, c.estimator);
}

bool isZero(const std::vector<double>& v) {
  return std::all_of(v.begin(), v.end(), [](double component) { return component == 0.0; });
}

// Conditions on several parameters together.
void checkTogether(const ControllerConfig& c, std::vector<std::string>& errors) {
  if (c.breathing.rate != 0.0 &&
      !Range(c.breathing.filter.min_frequency, c.breathing.filter.max_frequency).contains(c.breathing.rate)) {
    errors.push_back("breathing/rate = " + validation::numberText(c.breathing.rate) +
                     ", expected 0 or a number in [min_rate, max_rate] Hz");
  }
  for (const auto& [name, direction] :
       {std::pair("range/axis", &c.range.axis), std::pair("horizon/up", &c.horizon.up)}) {
    if (isZero(*direction))
      errors.push_back(std::string(name) + " is no direction, expected numbers that are not all zero");
  }
  // The dead zone's inverse stays within the limits.
  const Eigen::Vector4d room = c.limits.velocity.vector() - c.dead_zone.width.vector();
  if (c.dead_zone.inverse && !(room.array() > 0.0).all())
    errors.emplace_back("limits/velocity is not above dead_zone/width, expected more in each component");
  if (!errors.empty()) return;
  for (const std::string& error : validate(c.breathing.filter)) errors.push_back("breathing/filter: " + error);
  for (const std::string& error : validate(c.insertion_point.estimator)) errors.push_back("insertion_point/" + error);
}

}  // namespace

void describe(Table& table, ControllerConfig& c) {
  table.choice("law", c.law, {"features", "paper"},
               "features: the region's centre, depth and orientation; paper: eq. (11) of Bourger et al. (2007)");
  table.choice("spin", c.spin, {"servo", "upright", "released"},
               "use of the scope's spin: keeps the region's orientation, keeps the picture upright, or none");
  table.group("features", "gains of the law features", [&] { describeFeatures(table, c.features); });
  table.group("gains", "gains of the law paper", [&] { describeGains(table, c.gains); });
  table.group("predictor", "the error when a command will be executed", [&] { describePredictor(table, c.predictor); });
  table.group("target", "model of the target's own motion and of the noise", [&] { describeTarget(table, c.target); });
  table.group("breathing", "the target's periodic motion", [&] { describeBreathing(table, c.breathing); });
  table.group("rest", "within these bands about the target the scope rests", [&] { describeRest(table, c.rest); });
  table.group("oscillation", "lowers the gains when the loop oscillates about the target",
              [&] { describeOscillation(table, c.oscillation); });
  table.group("dead_zone", "slower commands are not executed by the robot", [&] {
    table.flag("inverse", c.dead_zone.inverse, "the width is added to the law's velocity");
    table.group("width", "", [&] { describeVelocity(table, c.dead_zone.width, {0, 0.1}, {0, 0.02}, "s"); });
  });
  const std::string limits =
      "the four components of a motion are scaled together, so that its direction is kept; spin and insertion are "
      "slowed down for themselves while the guard of effect has not seen enough";
  table.group("limits", limits, [&] {
    // Not zero: the components are scaled together, so a zero limit would stop all of them. A gain of zero stops a
    // single one.
    table.group("velocity", "above dead_zone/width where its inverse is used", [&] {
      describeVelocity(table, c.limits.velocity, {1e-6, 1}, {1e-6, 0.1}, "s");
    });
    table.group("acceleration", "does not limit a safety stop, which is immediate", [&] {
      describeVelocity(table, c.limits.acceleration, {1e-6, 100}, {1e-6, 10}, "s^2");
    });
  });
  table.group("range", "workspace: the scope is slowed near a bound, and stops there",
              [&] { describeRange(table, c.range); });
  table.group("insertion_point", "where the shafts of the poses meet",
              [&] { describeInsertionPoint(table, c.insertion_point); });
  table.group("effect", "whether the picture moves as the scope's motion makes it move",
              [&] { describe(table, c.effect); });
  table.group("leash", "how far the scope follows the region from where it was brought to it",
              [&] { describe(table, c.leash); });
  table.group("horizon", "which way is up, for the spin upright", [&] {
    table.numbers("up", c.horizon.up, 3, Range::finite(), "", "direction in the insertion point's frame; not all zero");
  });
  table.group("stabilise", "the task STABILISE, which keeps the view of an anchor image by pan and tilt",
              [&] { describe(table, c.stabilise); });
  table.group("centre_tip", "the task CENTRE_TIP, which brings an instrument's tip back to a zone of the image",
              [&] { describe(table, c.centre_tip); });
  table.group("follow", "the task FOLLOW, which keeps a moving object in its place in the image by pan and tilt",
              [&] { describe(table, c.follow); });
  table.group("points", "the task POINTS, which brings points of texture to their desired places",
              [&] { describe(table, c.points); });
  table.group("safety", "what the scope has to be sure of before it moves", [&] { describe(table, c.safety); });
}

std::vector<std::string> validate(const ControllerConfig& config) {
  std::vector<std::string> errors = parameters::errorsOf(config);
  checkTogether(config, errors);
  return errors;
}

}  // namespace laparoscope_servo::servo
