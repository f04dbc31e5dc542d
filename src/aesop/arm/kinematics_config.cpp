#include "laparoscope_servo/aesop/kinematics_config.h"

#include <algorithm>
#include <functional>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::aesop {

namespace {

using parameters::Range;
using parameters::Row;
using parameters::Table;
using parameters::Value;

constexpr double kDegree = 3.14159265358979323846 / 180.0;

constexpr double kFar = 100.0;  // m or rad: larger numbers are typing errors

// A list of the numbers, 1 to 7, of the joints for which `holds` is true.
void describeJoints(Table& table, const std::string& name, KinematicsConfig& c,
                    const std::function<bool(const DhJoint&)>& holds, const std::function<void(DhJoint&, bool)>& set,
                    const std::string& meaning) {
  const auto get = [&c, holds] {
    std::vector<double> numbers;
    for (std::size_t k = 0; k < c.joints.size(); ++k) {
      if (holds(c.joints[k])) numbers.push_back(static_cast<double>(k + 1));
    }
    return Value(numbers);
  };
  const auto take = [&c, set](const Value& value) {
    const auto& numbers = std::get<std::vector<double>>(value);
    for (std::size_t k = 0; k < c.joints.size(); ++k)
      set(c.joints[k], std::find(numbers.begin(), numbers.end(), static_cast<double>(k + 1)) != numbers.end());
  };
  Row& row = table.other(name, Row::Kind::kNumbers, get, take, meaning).whole();
  row.range = {1, kJoints};
  row.unit = "joint numbers";
}

// Both lists together define the role of every joint, in whichever order they are read; if one is missing, its default
// holds.
void describeRole(Table& table, const std::string& name, KinematicsConfig& c, JointRole role, JointRole other,
                  const std::string& meaning) {
  const auto holds = [role](const DhJoint& joint) { return joint.role == role || joint.role == JointRole::kBoth; };
  const auto set = [role, other, holds](DhJoint& joint, bool listed) {
    const bool is_other = joint.role == other || joint.role == JointRole::kBoth;
    joint.role = listed ? (is_other ? JointRole::kBoth : role) : is_other ? other : JointRole::kPassive;
  };
  describeJoints(table, name, c, holds, set, meaning);
}

void describeField(Table& table, const std::string& name, KinematicsConfig& c, double DhJoint::*field,
                   const Range& range, const std::string& unit, const std::string& meaning) {
  table.numbers(name, &(c.joints[0].*field), kJoints, range, unit, meaning, sizeof(DhJoint));
}

}  // namespace

std::array<DhJoint, kJoints> nominalJoints() {
  constexpr JointRole driven = JointRole::kDriven;
  constexpr JointRole hand = JointRole::kHand;
  constexpr JointRole passive = JointRole::kPassive;
  // prismatic, role, alpha, a, d, theta, minimum, maximum, max_speed
  return {{{true, driven, 0.0, 0.0, 0.0, 0.0, 0.0, 0.381, 0.05},
           {false, driven, 0.0, 0.39, 0.0, 0.0, -157.5 * kDegree, 157.5 * kDegree, 0.3},
           {false, driven, 90.0 * kDegree, 0.09, 0.0, 0.0, -141.0 * kDegree, 141.0 * kDegree, 0.3},
           {false, hand, 90.0 * kDegree, 0.0, 0.0, 90.0 * kDegree, -45.0 * kDegree, 45.0 * kDegree, 0.3},
           {false, passive, 90.0 * kDegree, 0.0, 0.295, 180.0 * kDegree, -135.0 * kDegree, 135.0 * kDegree, 1.0},
           {false, passive, -90.0 * kDegree, 0.0165, 0.0, 90.0 * kDegree, -90.0 * kDegree, 90.0 * kDegree, 1.0},
           // No stop of the spin is known; two turns each way spare the cables of the camera.
           {false, driven, 180.0 * kDegree, 0.0, -0.1, 0.0, -720.0 * kDegree, 720.0 * kDegree, 0.5}}};
}

void describe(Table& table, KinematicsConfig& c) {
  const Range any(-kFar, kFar);
  describeJoints(
      table, "prismatic", c, [](const DhJoint& joint) { return joint.prismatic; },
      [](DhJoint& joint, bool listed) { joint.prismatic = listed; }, "the others turn");
  describeRole(table, "driven", c, JointRole::kDriven, JointRole::kHand, "exactly four");
  describeRole(table, "by_hand", c, JointRole::kHand, JointRole::kDriven,
               "those in neither list are passive: exactly two, and they turn");
  describeField(table, "alpha", c, &DhJoint::alpha, any, "rad", "standard Denavit-Hartenberg");
  describeField(table, "a", c, &DhJoint::a, any, "m", "standard Denavit-Hartenberg");
  describeField(table, "d", c, &DhJoint::d, any, "m", "standard Denavit-Hartenberg");
  describeField(table, "theta", c, &DhJoint::theta, any, "rad", "standard Denavit-Hartenberg");
  describeField(table, "minimum", c, &DhJoint::minimum, any, "m or rad", "least position; m of a prismatic joint");
  describeField(table, "maximum", c, &DhJoint::maximum, any, "m or rad", "largest position, each above the least");
  describeField(table, "max_speed", c, &DhJoint::max_speed, Range::above(0, kFar), "m/s or rad/s",
                "largest speed; m/s of a prismatic joint");
  table.number("scope_length", c.scope_length, Range::between(0, 1), "m",
               "from the end effector's origin to the camera along the shaft");
  table.number("depth_minimum", c.depth_minimum, Range::above(0, 1), "m",
               "least depth of the camera beyond the insertion point");
  table
      .number("depth_maximum", c.depth_maximum, Range::above(0, 1), "m",
              "largest depth of the camera beyond the insertion point")
      .above("depth_minimum")
      .below("scope_length");
}

void describe(Table& table, MotionConfig& c) {
  table.number("limit_margin_angle", c.limit_margin_angle, Range::between(0, 1), "rad",
               "distance from a revolute joint's limit within which it is slowed");
  table.number("limit_margin_distance", c.limit_margin_distance, Range::between(0, 0.1), "m",
               "distance from a prismatic joint's limit, and from the depths of kinematics, within which it is slowed");
  table
      .number("singular_slow", c.singular_slow, Range::between(0, 1), "",
              "slowed below this smallest singular value (lengths over 0.3 m)")
      .above("singular_stop");
  table.number("singular_stop", c.singular_stop, Range::between(0, 1), "", "stops below this smallest singular value");
  table
      .number("lever_slow", c.lever_slow, Range::between(0.01, 0.3), "m",
              "slowed below this d1, from the end effector to the insertion point, in pan, tilt and deeper")
      .above("lever_stop");
  table.number("lever_stop", c.lever_stop, Range::between(0.01, 0.3), "m", "stops below this d1");
  table.number("stopping_time", c.stopping_time, {0.05, 5}, "s",
               "time to a limit below which motion is slowed; at least the time from a command to joints at rest, "
               "delay included");
}

std::vector<std::string> validate(const KinematicsConfig& config) {
  std::vector<std::string> errors = parameters::errorsOf(config);
  int driven = 0;
  int passive = 0;
  for (int k = 0; k < kJoints; ++k) {
    const DhJoint& joint = config.joints[static_cast<std::size_t>(k)];
    const std::string name = "joint " + std::to_string(k + 1);
    driven += joint.role == JointRole::kDriven ? 1 : 0;
    passive += joint.role == JointRole::kPassive ? 1 : 0;
    if (joint.role == JointRole::kBoth) errors.push_back(name + " is listed as driven and as by_hand");
    if (joint.role == JointRole::kPassive && joint.prismatic)
      errors.push_back(name + " is passive and prismatic, expected passive joints to turn");
    if (joint.maximum <= joint.minimum) {
      errors.push_back("maximum[" + std::to_string(k) + "] = " + validation::numberText(joint.maximum) +
                       ", expected above minimum[" + std::to_string(k) +
                       "] = " + validation::numberText(joint.minimum));
    }
  }
  if (driven != 4) errors.push_back("number of driven joints = " + std::to_string(driven) + ", expected 4");
  if (passive != 2) errors.push_back("number of passive joints = " + std::to_string(passive) + ", expected 2");
  return errors;
}

std::vector<std::string> validate(const MotionConfig& config) {
  return parameters::errorsOf(config);
}

}  // namespace laparoscope_servo::aesop
