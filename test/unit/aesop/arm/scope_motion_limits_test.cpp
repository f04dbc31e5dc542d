// What holds at any state of the arm, and what happens on the way to where motion has to end.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "laparoscope_servo/aesop/scope_motion.h"
#include "laparoscope_servo/geometry/se3.h"
#include "unit/aesop/nominal_pose.h"

namespace laparoscope_servo::aesop {
namespace {

const Kinematics kKinematics{KinematicsConfig()};
const MotionConfig kConfig;

struct State {
  JointVector q;
  Eigen::Vector3d trocar;
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(engine_); }

  // Anywhere within the joints' limits, the trocar anywhere on the shaft that the depths allow.
  State state() {
    State state;
    for (int k = 0; k < kJoints; ++k) {
      const DhJoint& joint = kKinematics.config().joints[static_cast<std::size_t>(k)];
      state.q[k] = uniform(joint.minimum, joint.maximum);
    }
    const double d2 = uniform(KinematicsConfig().depth_minimum, KinematicsConfig().depth_maximum);
    state.trocar = kKinematics.endEffector(state.q) * Eigen::Vector3d(0.0, 0.0, KinematicsConfig().scope_length - d2);
    return state;
  }
  scope::Velocity velocity(double size = 1.0) {
    return {uniform(-0.15, 0.15) * size, uniform(-0.15, 0.15) * size, uniform(-0.3, 0.3) * size,
            uniform(-0.03, 0.03) * size};
  }

 private:
  std::mt19937 engine_;
};

Eigen::Vector4d vector(const scope::Velocity& v) {
  return {v.pan, v.tilt, v.spin, v.insertion};
}

TEST(ScopeMotionEverywhere, shaftStaysInTheTrocarAndDirectionIsKept) {
  Random random(1);
  std::map<std::string, int> reasons;
  for (int trial = 0; trial < 5000; ++trial) {
    const State state = random.state();
    const scope::Velocity wanted = random.velocity();
    const JointMotion motion = jointMotion(kKinematics, kConfig, state.q, state.trocar, wanted);
    ASSERT_TRUE(motion.velocity.allFinite());
    ASSERT_GE(motion.scale, 0.0);
    ASSERT_LE(motion.scale, 1.0);
    EXPECT_EQ(motion.reason.empty(), motion.scale == 1.0);
    const std::string kind = motion.reason.substr(0, motion.reason.find(' '));
    ++reasons[motion.reason.find("joint") != std::string::npos ? kind + " joint" : kind];
    for (int k = 0; k < kJoints; ++k) {
      ASSERT_LE(std::abs(motion.velocity[k]), KinematicsConfig().joints[static_cast<std::size_t>(k)].max_speed + 1e-9);
    }
    const geometry::Vector6d twist = kKinematics.jacobian(state.q) * motion.velocity;
    const Eigen::Isometry3d end = kKinematics.endEffector(state.q);
    const Eigen::Vector3d w = twist.tail<3>();
    const Eigen::Vector3d at_trocar = twist.head<3>() + w.cross(state.trocar - end.translation());
    const Eigen::Vector3d lateral = end.linear().transpose() * at_trocar;
    EXPECT_LT(lateral.head<2>().norm(), 1e-11) << "joints at " << state.q.transpose();
    const Eigen::Vector4d got = vector(scopeVelocity(kKinematics, state.q, motion.velocity));
    EXPECT_LT((got - motion.scale * vector(wanted)).norm(), 1e-11) << motion.reason;
  }
  for (const char* kind : {"", "slowed: joint", "held:", "slowed:"}) EXPECT_GT(reasons[kind], 20) << kind;
}

TEST(ScopeMotionEverywhere, jointSpeedsAreBoundedAtAndNearSingularPositions) {
  Random random(2);
  for (int trial = 0; trial < 2000; ++trial) {
    State state = random.state();
    // Elbow straight; spin axis along that of joint 5; both.
    const double near = trial % 4 == 0 ? 0.0 : std::pow(10.0, random.uniform(-9.0, -1.0));
    if (trial % 3 != 1) state.q[2] = near;
    if (trial % 3 != 0) state.q[5] = M_PI / 2.0 - near;
    state.trocar = kKinematics.endEffector(state.q) * Eigen::Vector3d(0.0, 0.0, 0.2);
    const JointMotion motion = jointMotion(kKinematics, kConfig, state.q, state.trocar, random.velocity());
    ASSERT_TRUE(motion.velocity.allFinite());
    for (int k = 0; k < kJoints; ++k) {
      ASSERT_LE(std::abs(motion.velocity[k]), KinematicsConfig().joints[static_cast<std::size_t>(k)].max_speed + 1e-9);
    }
  }
}

// Scale along a way to a bound, `room` being what is left: never more for less room, without a jump, zero at the bound.
void expectSlowedThenHeld(const std::function<JointMotion(double room)>& at, double margin, const std::string& what) {
  double previous = 1.0;
  bool slowed = false;
  EXPECT_EQ(at(4.0 * margin).scale, 1.0) << what;
  for (double room = 4.0 * margin; room > -0.2 * margin; room -= 0.01 * margin) {
    const JointMotion motion = at(room);
    ASSERT_LE(motion.scale, previous + 1e-9) << what << ", room " << room;
    ASSERT_LE(previous - motion.scale, 0.02) << what << ": a jump at room " << room;
    if (motion.scale < 1.0) {
      EXPECT_NE(motion.reason.find(what), std::string::npos) << motion.reason;
    }
    if (room <= 0.0) {
      ASSERT_EQ(motion.scale, 0.0) << what;
      EXPECT_EQ(motion.velocity, JointVector::Zero());
      EXPECT_EQ(motion.reason.rfind("held: ", 0), 0u) << motion.reason;
    } else if (motion.scale < 1.0 && motion.scale > 0.0) {
      slowed = true;
      EXPECT_EQ(motion.reason.rfind("slowed: ", 0), 0u) << motion.reason;
    }
    previous = motion.scale;
  }
  EXPECT_TRUE(slowed) << what;
}

TEST(ScopeMotionLimits, everyMovingJointIsSlowedThenHeldAndLetBack) {
  const scope::Velocity velocity{0.01, 0.02, 0.01, 0.002};
  const scope::Velocity back{-0.01, -0.02, -0.01, -0.002};
  const JointVector speed = jointMotion(kKinematics, kConfig, nominalPose(), nominalTrocar(), velocity).velocity;
  for (const int joint : {0, 1, 2, 4, 5, 6}) {
    ASSERT_NE(speed[joint], 0.0);
    const double margin = joint == 0 ? kConfig.limit_margin_distance : kConfig.limit_margin_angle;
    const auto with = [&](double room, const scope::Velocity& v) {
      KinematicsConfig limited;
      DhJoint& limits = limited.joints[static_cast<std::size_t>(joint)];
      limits.minimum = speed[joint] > 0.0 ? -10.0 : nominalPose()[joint] - room;
      limits.maximum = speed[joint] > 0.0 ? nominalPose()[joint] + room : 10.0;
      return jointMotion(Kinematics(limited), kConfig, nominalPose(), nominalTrocar(), v);
    };
    const std::string name = "joint " + std::to_string(joint + 1);
    expectSlowedThenHeld([&](double room) { return with(room, velocity); }, margin, name);
    for (const double room : {margin, 0.0, -margin}) {
      EXPECT_EQ(with(room, back).scale, 1.0) << name << ": " << with(room, back).reason;
    }
  }
}

TEST(ScopeMotionLimits, fastMotionIsSlowedEarlierSoThatTheDelayDoesNotCarryItBeyond) {
  for (const double insertion : {0.001, 0.1, 0.3}) {
    for (double room = 0.0; room < 0.1; room += 0.001) {
      KinematicsConfig config;
      config.depth_maximum = 0.1 + room;
      config.joints[0].max_speed = 1.0;
      const JointMotion motion =
          jointMotion(Kinematics(config), kConfig, nominalPose(), nominalTrocar(), {0.0, 0.0, 0.0, insertion});
      EXPECT_LE(motion.scale * insertion * kConfig.stopping_time, room + 1e-9);
    }
  }
}

TEST(ScopeMotionLimits, depthIsSlowedThenHeldAndLetBack) {
  const auto with = [&](double deeper, double shallower, double insertion) {
    KinematicsConfig limited;
    limited.depth_maximum = 0.1 + deeper;
    limited.depth_minimum = 0.1 - shallower;
    return jointMotion(Kinematics(limited), kConfig, nominalPose(), nominalTrocar(), {0.0, 0.0, 0.0, insertion});
  };
  const double margin = kConfig.limit_margin_distance;
  expectSlowedThenHeld([&](double room) { return with(room, 0.09, 0.01); }, margin, "greatest depth");
  expectSlowedThenHeld([&](double room) { return with(0.09, room, -0.01); }, margin, "smallest depth");
  EXPECT_EQ(with(0.0, 0.09, -0.01).scale, 1.0);
  EXPECT_EQ(with(0.09, 0.0, 0.01).scale, 1.0);
}

TEST(ScopeMotionLimits, shortLeverIsSlowedThenHeldAndLetBack) {
  KinematicsConfig config;
  config.depth_maximum = 0.299;
  const Kinematics kinematics(config);
  const auto with = [&](double d1, const scope::Velocity& v) {
    const Eigen::Vector3d trocar = kinematics.endEffector(nominalPose()) * Eigen::Vector3d(0.0, 0.0, d1);
    return jointMotion(kinematics, kConfig, nominalPose(), trocar, v);
  };
  const double margin = kConfig.lever_slow - kConfig.lever_stop;
  for (const scope::Velocity& v : {scope::Velocity{0.01, 0.0, 0.0, 0.0}, scope::Velocity{0.0, -0.01, 0.1, 0.0},
                                   scope::Velocity{0.0, 0.0, 0.0, 0.004}}) {
    expectSlowedThenHeld([&](double room) { return with(kConfig.lever_stop + room, v); }, margin, "end effector");
  }
  for (const double d1 : {0.025, 0.0, -0.05}) {
    EXPECT_EQ(with(d1, {0.0, 0.0, 0.0, -0.01}).scale, 1.0) << with(d1, {0.0, 0.0, 0.0, -0.01}).reason;
    EXPECT_EQ(with(d1, {0.01, 0.0, 0.0, -0.01}).scale, 0.0) << "the direction is kept, so pan holds the way back, too";
  }
}

TEST(ScopeMotionLimits, singularPositionIsSlowedThenHeldAndLetBack) {
  // Pulls the scope along the stretching arm: the elbow straightens.
  const auto with = [&](double elbow, double sign) {
    JointVector q = nominalPose();
    q[2] = elbow;
    const Eigen::Isometry3d end = kKinematics.endEffector(q);
    const Eigen::Vector3d trocar = end * Eigen::Vector3d(0.0, 0.0, 0.2);
    const Eigen::Vector3d outwards =
        end.linear().transpose() * Eigen::Vector3d(end.translation().x(), end.translation().y(), 0.0).normalized();
    // O_7 moves by (-d1 pan, d1 tilt).
    return jointMotion(kKinematics, kConfig, q, trocar,
                       {-0.02 * sign * outwards.x(), 0.02 * sign * outwards.y(), 0.0, 0.0});
  };
  double previous = 1.0;
  bool slowed = false;
  bool held = false;
  for (double elbow = 1.2; elbow > 0.01; elbow -= 0.002) {
    JointVector q = nominalPose();
    q[2] = elbow;
    const double value = conditioning(kKinematics, q);
    const JointMotion motion = with(elbow, 1.0);
    ASSERT_LT(motion.velocity[2], 1e-12) << "the elbow straightens";
    ASSERT_LE(motion.scale, previous + 1e-9) << "elbow at " << elbow;
    ASSERT_LE(previous - motion.scale, 0.03) << "a jump, elbow at " << elbow;
    if (value <= kConfig.singular_stop) {
      ASSERT_EQ(motion.scale, 0.0);
      EXPECT_EQ(motion.reason, "held: the arm is near a singular position");
    }
    slowed = slowed || (motion.scale > 0.0 && motion.scale < 1.0);
    held = held || motion.scale == 0.0;
    const JointMotion away = with(elbow, -1.0);
    ASSERT_GT(away.scale, 0.0) << away.reason;
    EXPECT_EQ(away.reason.find("singular"), std::string::npos) << "elbow at " << elbow;
    previous = motion.scale;
  }
  EXPECT_TRUE(slowed);
  EXPECT_TRUE(held);
}

// Without delay: whatever is commanded, whatever the start, no bound is passed.
TEST(ScopeMotionLimits, noBoundIsEverPassed) {
  KinematicsConfig wide;  // by what the steps of this test are off
  for (DhJoint& joint : wide.joints) {
    joint.minimum -= 1e-4;
    joint.maximum += 1e-4;
  }
  const Kinematics follower(wide);
  Random random(3);
  int held = 0;
  int runs = 0;
  while (runs < 30) {
    State state = random.state();
    const double start = conditioning(kKinematics, state.q);
    if (start < 0.12 || !kKinematics.solveWrist(state.q, state.trocar).ok) continue;
    ++runs;
    const scope::Velocity velocity = random.velocity();
    JointMotion motion;
    for (int step = 0; step < 1500; ++step) {
      motion = jointMotion(kKinematics, kConfig, state.q, state.trocar, velocity);
      JointVector next = state.q;
      for (const int k : kKinematics.driven()) next[k] += 0.01 * motion.velocity[k];
      const WristSolution wrist = follower.solveWrist(next, state.trocar);
      ASSERT_TRUE(wrist.ok) << wrist.reason;
      state.q = wrist.q;
      ASSERT_EQ(follower.error(state.q), "") << motion.reason;
      ASSERT_GT(conditioning(kKinematics, state.q), std::min(start, kConfig.singular_stop) - 1e-3);
      const double d2 = KinematicsConfig().scope_length - kKinematics.leverArm(state.q, state.trocar);
      ASSERT_GT(d2, KinematicsConfig().depth_minimum - 1e-3);
      ASSERT_LT(d2, KinematicsConfig().depth_maximum + 1e-3);
    }
    held += motion.scale < 1e-2 ? 1 : 0;
  }
  EXPECT_GT(held, runs / 2) << "hardly any run has come to a bound";
}

}  // namespace
}  // namespace laparoscope_servo::aesop
