// The running node through random fault scripts: AESOP_FAULT_RUNS of them (6 unless set), from AESOP_FAULT_SEED on, a
// scope that is commanded all the time. In none may a joint move for longer than StopBounds allows after the last
// velocity that reached the controller, after the node has left ENABLED, or after a fault that has to stop the arm;
// each has to end in DISABLED and move again after `enable`, which is how the next one begins.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <map>

#include "support/random_faults.h"
#include "system/aesop/aesop_bench.h"

namespace laparoscope_servo::test {
namespace {

constexpr double kAnswer = 0.05;  // s, for the kernel to let the processes run
constexpr double kCommandPeriod = 0.02;

int setting(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoi(text);
}

class FaultRuns {
 public:
  explicit FaultRuns(AesopBench& bench) : bench_(bench), start_(kinematics_.optical(bench.truth().state().q)) {}

  void run(int seed) {
    RandomFaults random(static_cast<unsigned>(seed));
    const FaultScript script = random.draw();
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + script.text());
    chooseCommand(random);
    const bool moved = begin();
    EXPECT_TRUE(moved) << "not enabled or not moved: " << bench_.state_->state << ", " << bench_.state_->reason;
    if (moved) misbehave(script);
    recover();
  }

  void report(int count) const {
    std::cout << count << " scripts; longest motion: after the last velocity taken "
              << bench_.truth().record().longest_motion << " s (allowed " << bounds_.afterArrival()
              << "), after the node left ENABLED " << after_enabled_ << " s, after a fault that has to stop the arm "
              << after_fault_ << " s (both allowed " << bounds_.afterSending()
              << " and what the line held back); longest recovery to DISABLED " << recovery_
              << " s; left ENABLED because:\n";
    for (const auto& [reason, times] : reasons_) std::cout << "  " << times << " x " << reason << '\n';
    std::cout << std::flush;
  }

 private:
  // Back towards where the scope was at the beginning, so that a thousand runs stay in the arm's range.
  void chooseCommand(RandomFaults& random) {
    const Eigen::Isometry3d now = kinematics_.optical(bench_.truth().state().q);
    const Eigen::Vector3d axis = start_.linear().transpose() * now.linear().col(2);
    const double depth = (start_.inverse() * now.translation()).z();
    command_ = ScopeVelocity();
    command_.pan = (axis.x() > 0.0 ? -1.0 : 1.0) * random.real(0.03, 0.08);
    command_.tilt = (axis.y() > 0.0 ? 1.0 : -1.0) * random.real(0.0, 0.05);
    command_.insertion = (depth > 0.0 ? -1.0 : 1.0) * random.real(0.0, 0.005);
  }

  void command(double seconds, const std::function<void()>& watch) {
    double next = 0.0;
    bench_.waitFor(
        [&] {
          if (steadyNow() >= next) {
            next = steadyNow() + kCommandPeriod;
            bench_.send(command_);
          }
          watch();
          return false;
        },
        seconds);
  }

  bool begin() {
    if (!bench_.waitFor([&] { return bench_.isUp() && !bench_.jointsMove(); })) return false;
    if (!bench_.enable()) return false;
    const double limit = steadyNow() + 3.0;
    while (!bench_.jointsMove() && steadyNow() < limit) command(0.02, [] {});
    command(0.2, [] {});
    return bench_.jointsMove();
  }

  void misbehave(const FaultScript& script) {
    const double begin = steadyNow();
    for (const std::string& request : script.requests()) bench_.truth().request(request);
    const double stop = begin + script.stopsAt();
    double left_enabled = std::numeric_limits<double>::infinity();
    double moved_after_enabled = 0.0;
    double moved_after_fault = 0.0;
    bool too_fast = false;
    command(script.end() + bounds_.afterSending() + script.heldBack() + 0.3, [&] {
      if (bench_.stateIs("ENABLED")) left_enabled = std::numeric_limits<double>::infinity();
      if (!bench_.stateIs("ENABLED") && std::isinf(left_enabled)) {
        left_enabled = steadyNow();
        ++reasons_[withoutNumbers(bench_.state_->reason)];
      }
      const double moved = steadyNow() - bench_.truth().record().motion_age;
      moved_after_enabled = std::max(moved_after_enabled, moved - left_enabled);
      moved_after_fault = std::max(moved_after_fault, moved - stop);
      too_fast = too_fast || (!script.misleads() && isTooFast());
    });
    const double allowed = bounds_.afterSending() + script.heldBack() + kAnswer;
    EXPECT_LE(moved_after_enabled, allowed) << "it moves, and is not ENABLED";
    EXPECT_LE(moved_after_fault, allowed) << "it moves after a fault that has to stop it";
    EXPECT_LE(bench_.truth().record().longest_motion, bounds_.afterArrival() + 0.01);
    EXPECT_FALSE(too_fast) << "a velocity that nobody has commanded";
    after_enabled_ = std::max(after_enabled_, moved_after_enabled);
    after_fault_ = std::max(after_fault_, moved_after_fault);
  }

  bool isTooFast() {
    const scope::Velocity v = aesop::scopeVelocity(kinematics_, bench_.truth().state().q, bench_.truth().motion().qdot);
    return std::abs(v.pan) > 1.1 * std::abs(command_.pan) + 0.008 ||
           std::abs(v.tilt) > 1.1 * std::abs(command_.tilt) + 0.008 ||
           std::abs(v.insertion) > 1.1 * std::abs(command_.insertion) + 0.002;
  }

  void recover() {
    bench_.truth().request("forget");
    bench_.truth().fault("none");
    const double begin = steadyNow();
    // The state that the topic told last may be from before.
    command(0.3, [] {});
    EXPECT_TRUE(bench_.waitFor([&] { return bench_.isUp() && !bench_.jointsMove(); }, 12.0))  // the pauses grow
        << bench_.state_->state << ", " << bench_.state_->reason;
    if (bench_.stateIs("FAULT")) {
      EXPECT_TRUE(bench_.call("clear_fault").success);
    } else if (bench_.stateIs("ENABLED")) {
      EXPECT_TRUE(bench_.call("disable").success);
    }
    EXPECT_TRUE(bench_.waitFor([&] { return bench_.stateIs("DISABLED"); }, 3.0)) << bench_.state_->state;
    recovery_ = std::max(recovery_, steadyNow() - begin);
    const aesop::JointVector before = bench_.truth().state().q;
    command(0.2, [] {});
    EXPECT_EQ(bench_.truth().state().q, before) << "it moved without an enable";
  }

  static std::string withoutNumbers(std::string text) {
    std::string result;
    for (const char c : text) {
      const bool number = std::string("-0123456789.").find(c) != std::string::npos;
      if (!number || result.empty() || result.back() != '#') result += number ? '#' : c;
    }
    return result;
  }

  AesopBench& bench_;
  aesop::Kinematics kinematics_{aesop::KinematicsConfig()};
  Eigen::Isometry3d start_;
  StopBounds bounds_;
  ScopeVelocity command_;
  double after_enabled_ = 0.0;
  double after_fault_ = 0.0;
  double recovery_ = 0.0;
  std::map<std::string, int> reasons_;
};

TEST(AesopFaults, noneMovesTheArmForLongerThanItMayAndAllAreRecoveredFrom) {
  const int first = setting("AESOP_FAULT_SEED", 1);
  const int count = setting("AESOP_FAULT_RUNS", 6);
  AesopBench bench;
  FaultRuns runs(bench);
  for (int seed = first; seed < first + count; ++seed) {
    runs.run(seed);
    ASSERT_TRUE(bench.node().isRunning());
    if ((seed - first + 1) % 50 == 0) runs.report(seed - first + 1);
  }
  runs.report(count);
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "aesop_faults_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
