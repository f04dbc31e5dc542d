// The emulated arm driven as the driver does it, with the arm's delay, dead zones and friction: where the shaft goes,
// and how near a joint comes to its limits.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/scope/insertion_point.h"
#include "laparoscope_servo/sim/arm.h"

namespace laparoscope_servo::sim {
namespace {

using aesop::JointVector;
using aesop::kJoints;
using Eigen::Vector3d;
using scope::Velocity;

constexpr double kPeriod = 0.025;  // s, of the link

class Drive {
 public:
  explicit Drive(const aesop::KinematicsConfig& config = aesop::KinematicsConfig(), const ArmConfig& arm = ArmConfig())
      : kinematics(config), believed(ArmConfig().insertion_point), true_(arm.insertion_point), arm_(kinematics, arm) {
    arm_.step(0.0);
  }

  // One exchange on the link; the velocities on the wire are in millionths, and so are the positions that come back.
  void step(const scope::Velocity& velocity) {
    const JointVector q = (arm_.position() * 1e6).array().round() / 1e6;
    motion = aesop::jointMotion(kinematics, aesop::MotionConfig(), q, believed, velocity);
    std::array<double, aesop::kDrivenJoints> speed{};
    for (std::size_t k = 0; k < speed.size(); ++k) speed[k] = motion.velocity[kinematics.driven()[k]];
    arm_.command(speed, now_);
    now_ += kPeriod;
    arm_.step(now_);
    for (int k = 0; k < kJoints; ++k) {
      const aesop::DhJoint& joint = kinematics.config().joints[static_cast<std::size_t>(k)];
      least_room_ = std::min({least_room_, arm_.position()[k] - joint.minimum, joint.maximum - arm_.position()[k]});
    }
    depth_ = kinematics.config().scope_length - kinematics.leverArm(arm_.position(), true_);
    largest_offset_ = std::max(largest_offset_, offset(q, true_));
    const Eigen::Isometry3d end = kinematics.endEffector(arm_.position());
    const geometry::Vector6d twist = kinematics.jacobian(arm_.position()) * arm_.velocity();
    const Vector3d w = twist.tail<3>();
    const Vector3d at_trocar = end.linear().transpose() * (twist.head<3>() + w.cross(true_ - end.translation()));
    largest_lateral_speed_ = std::max(largest_lateral_speed_, at_trocar.head<2>().norm());
  }

  double offset(const JointVector& q, const Vector3d& point) const {
    return Vector3d(kinematics.endEffector(q).inverse() * point).head<2>().norm();
  }
  const JointVector& q() const { return arm_.position(); }
  const std::string& stuck() const { return arm_.stuck(); }

  const aesop::Kinematics kinematics;
  Vector3d believed;
  aesop::JointMotion motion;
  double least_room_ = 1e9;  // m or rad, to the nearest limit of any joint
  double depth_ = 0.0;       // m
  double largest_offset_ = 0.0;
  double largest_lateral_speed_ = 0.0;

 private:
  Vector3d true_;
  Arm arm_;
  double now_ = 0.0;
};

// Each velocity for as long as it likes: steps, not a smooth path, and speeds up to all that the node lets through.
void driveAtRandom(Drive& drive, unsigned seed, double seconds) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  scope::Velocity velocity;
  double until = 0.0;
  for (double t = 0.0; t < seconds; t += kPeriod) {
    if (t >= until) {
      velocity = {0.15 * uniform(random), 0.15 * uniform(random), 0.3 * uniform(random), 0.03 * uniform(random)};
      until = t + 1.5 + uniform(random);
    }
    drive.step(velocity);
  }
}

TEST(ArmDrive, RandomCommandsKeepTheShaftInTheTrocar) {
  double offset = 0.0;
  double speed = 0.0;
  for (unsigned seed = 0; seed < 5; ++seed) {
    Drive drive;
    driveAtRandom(drive, seed, 60.0);
    EXPECT_EQ(drive.stuck(), "");
    offset = std::max(offset, drive.largest_offset_);
    speed = std::max(speed, drive.largest_lateral_speed_);
  }
  EXPECT_LT(offset, 3e-6) << "the shaft by joint positions in millionths";
  EXPECT_LT(speed, 1e-3) << "differences over a step of the arm, at up to 0.15 rad/s";
  RecordProperty("largest_offset_m", std::to_string(offset));
  RecordProperty("largest_lateral_speed", std::to_string(speed));
}

// With a passive wrist a wrong insertion point pushes nothing; it scales pan and tilt by how wrong d1 is.
TEST(ArmDrive, AWrongInsertionPointScalesPanAndPushesNothing) {
  for (const Vector3d& wrong : {Vector3d(0.01, 0.0, 0.0), Vector3d(0.0, 0.01, 0.0), Vector3d(0.0, 0.0, 0.01)}) {
    ArmConfig config;
    config.insertion_point += wrong;
    Drive drive(aesop::KinematicsConfig(), config);
    driveAtRandom(drive, 1, 60.0);
    EXPECT_EQ(drive.stuck(), "");
    EXPECT_LT(drive.largest_offset_, 3e-6);

    Drive pan(aesop::KinematicsConfig(), config);
    const Eigen::Matrix3d before = pan.kinematics.endEffector(pan.q()).linear();
    const double d1 = pan.kinematics.leverArm(pan.q(), config.insertion_point);
    const double believed_d1 = pan.kinematics.leverArm(pan.q(), pan.believed);
    for (double t = 0.0; t < 4.0; t += kPeriod) pan.step({t < 2.0 ? 0.08 : 0.0, 0.0, 0.0, 0.0});
    const Eigen::Matrix3d turned = before.transpose() * pan.kinematics.endEffector(pan.q()).linear();
    EXPECT_NEAR(std::asin(turned(0, 2)), 0.16 * believed_d1 / d1, 0.004) << wrong.transpose();
    EXPECT_NEAR(turned(1, 2), 0.0, 0.01) << wrong.transpose();
  }
}

// The delay is 0.16 s; without an allowance for it, joints would run past where they have to stand.
TEST(ArmDrive, TheDelayCarriesNoJointToItsLimit) {
  const double c = 1.0 / std::sqrt(2.0);
  int bounds = 0;
  for (const scope::Velocity& v :
       {scope::Velocity{0, 0, 0, 0.03}, scope::Velocity{0, 0, 0, -0.03}, scope::Velocity{0.15, 0, 0, 0},
        scope::Velocity{-0.15, 0, 0, 0}, scope::Velocity{0, 0.15, 0, 0}, scope::Velocity{0, -0.15, 0, 0},
        scope::Velocity{0.15 * c, 0.15 * c, 0, 0}, scope::Velocity{0, 0, 0.3, 0}, scope::Velocity{0.05, 0, 0, -0.02}}) {
    aesop::KinematicsConfig config;
    config.joints[0].minimum = 0.2;
    config.joints[0].maximum = 0.3;
    config.joints[4].minimum = config.joints[5].minimum = -0.4;
    config.joints[4].maximum = config.joints[5].maximum = 0.4;
    config.joints[6].minimum = -1.0;
    config.joints[6].maximum = 1.0;
    Drive drive(config);
    for (double t = 0.0; t < 20.0; t += kPeriod) drive.step(v);
    EXPECT_EQ(drive.stuck(), "");
    EXPECT_GT(drive.least_room_, 0.0) << drive.motion.reason;
    EXPECT_LT(drive.depth_, config.depth_maximum);
    EXPECT_GT(drive.depth_, config.depth_minimum);
    EXPECT_GT(aesop::conditioning(drive.kinematics, drive.q()), aesop::MotionConfig().singular_stop);
    EXPECT_FALSE(drive.motion.reason.empty());
    bounds += drive.motion.scale < 0.2 ? 1 : 0;
  }
  EXPECT_GE(bounds, 8) << "the arm has come to few bounds";
}

}  // namespace
}  // namespace laparoscope_servo::sim
