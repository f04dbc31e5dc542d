#include "laparoscope_servo/aesop/kinematics_config.h"

#include <cmath>
#include <sstream>

namespace laparoscope_servo::aesop {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

template <typename T>
std::string describe(const std::string& field, const T& value, const std::string& expected) {
  std::ostringstream text;
  text << field << " = " << value << ", expected " << expected;
  return text.str();
}

void checkJoint(const DhJoint& joint, int number, std::vector<std::string>& errors) {
  const std::string name = "joint " + std::to_string(number) + ": ";
  const std::pair<const char*, double> finite[] = {
      {"alpha", joint.alpha}, {"a", joint.a}, {"d", joint.d}, {"theta", joint.theta}, {"minimum", joint.minimum}};
  for (const auto& [field, value] : finite) {
    if (!std::isfinite(value)) errors.push_back(describe(name + field, value, "a finite number"));
  }
  if (!(joint.maximum > joint.minimum) || !std::isfinite(joint.maximum)) {
    errors.push_back(describe(name + "maximum", joint.maximum, "a number above its minimum"));
  }
  if (!(joint.max_speed > 0.0) || !std::isfinite(joint.max_speed)) {
    errors.push_back(describe(name + "max_speed", joint.max_speed, "a positive number"));
  }
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

std::vector<std::string> validate(const KinematicsConfig& config) {
  std::vector<std::string> errors;
  int driven = 0;
  int passive = 0;
  for (int k = 0; k < kJoints; ++k) {
    const DhJoint& joint = config.joints[static_cast<std::size_t>(k)];
    checkJoint(joint, k + 1, errors);
    driven += joint.role == JointRole::kDriven ? 1 : 0;
    passive += joint.role == JointRole::kPassive ? 1 : 0;
    if (joint.role == JointRole::kPassive && joint.prismatic) {
      errors.push_back("joint " + std::to_string(k + 1) + " is passive and prismatic, expected passive joints to turn");
    }
  }
  if (driven != 4) errors.push_back(describe("number of driven joints", driven, "4"));
  if (passive != 2) errors.push_back(describe("number of passive joints", passive, "2"));
  if (!(config.scope_length > 0.0 && config.scope_length < 1.0)) {
    errors.push_back(describe("scope_length", config.scope_length, "above 0 and below 1 m"));
  }
  if (!(config.depth_minimum > 0.0)) {
    errors.push_back(describe("depth_minimum", config.depth_minimum, "above 0 m"));
  }
  if (!(config.depth_maximum > config.depth_minimum && config.depth_maximum < config.scope_length)) {
    errors.push_back(describe("depth_maximum", config.depth_maximum, "above depth_minimum and below scope_length"));
  }
  return errors;
}

std::vector<std::string> validate(const MotionConfig& config) {
  std::vector<std::string> errors;
  if (!(config.limit_margin_angle > 0.0 && config.limit_margin_angle < 1.0)) {
    errors.push_back(describe("limit_margin_angle", config.limit_margin_angle, "above 0 and below 1 rad"));
  }
  if (!(config.limit_margin_distance > 0.0 && config.limit_margin_distance < 0.1)) {
    errors.push_back(describe("limit_margin_distance", config.limit_margin_distance, "above 0 and below 0.1 m"));
  }
  if (!(config.singular_stop > 0.0)) errors.push_back(describe("singular_stop", config.singular_stop, "above 0"));
  if (!(config.singular_slow > config.singular_stop && config.singular_slow < 1.0)) {
    errors.push_back(describe("singular_slow", config.singular_slow, "above singular_stop and below 1"));
  }
  if (!(config.lever_stop > 0.01)) errors.push_back(describe("lever_stop", config.lever_stop, "above 0.01 m"));
  if (!(config.lever_slow > config.lever_stop && config.lever_slow < 0.3)) {
    errors.push_back(describe("lever_slow", config.lever_slow, "above lever_stop and below 0.3 m"));
  }
  if (!(config.stopping_time >= 0.05 && config.stopping_time <= 5.0)) {
    errors.push_back(describe("stopping_time", config.stopping_time, "0.05 to 5 s"));
  }
  return errors;
}

}  // namespace laparoscope_servo::aesop
