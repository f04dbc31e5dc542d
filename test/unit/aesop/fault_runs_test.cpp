// The driver and the emulated controller in simulated time, through random fault scripts: AESOP_FAULT_RUNS of them (300
// unless set), from AESOP_FAULT_SEED on. The same is done to the node itself in test/system/aesop.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "laparoscope_servo/aesop/driver.h"
#include "support/random_faults.h"

namespace laparoscope_servo::aesop {
namespace {

constexpr double kTick = 0.005;
constexpr double kStampOffset = 1000.0;

int setting(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoi(text);
}

// Driver, line and controller; the port opens again by itself 0.5 s after it was lost.
class Cart {
 public:
  explicit Cart(unsigned seed) : wire_(seed, 38400) { driver_.opened(0.0); }

  // One tick; a command at 25 Hz when there is one.
  void step(const scope::Velocity& command) {
    now_ += kTick;
    faults_.step(now_);
    if (++ticks_ % 8 == 0 && !command.isZero()) {
      driver_.command(command, kStampOffset + now_, kStampOffset + now_, now_);
    }
    if (wire_.isCut(now_) && open_) {
      open_ = false;
      driver_.closed("the line has gone");
      reopen_ = now_ + 0.5;
    }
    if (!wire_.isCut(now_) && !open_ && now_ >= reopen_) {
      open_ = true;
      driver_.opened(now_);
    }
    if (open_) {
      const Bytes come = wire_.to_host.pop(now_);
      driver_.receive(come.data(), come.size(), now_);
      wire_.to_controller.push(driver_.transmit(now_), now_);
    }
    const Bytes arrived = wire_.to_controller.pop(now_);
    wire_.to_host.push(emulator_.receive(arrived.data(), arrived.size(), now_), now_);
    if (mode() == OperatingMode::kEnabled) not_enabled_since_ = now_ + kTick;
    if (emulator_.arm().velocity().isZero(0.0)) standing_since_ = now_;
  }
  template <typename Condition>
  bool until(Condition condition, double seconds, const scope::Velocity& command = {}) {
    for (const double end = now_ + seconds; !condition();) {
      if (now_ > end) return false;
      step(command);
    }
    return true;
  }

  std::string enable() { return driver_.enable(kStampOffset + now_, now_); }
  OperatingMode mode() const { return driver_.state(now_).mode; }
  bool isUp() const { return driver_.session().link().isUp() && driver_.session().link().status().has_value(); }
  bool moves() const { return !emulator_.arm().velocity().isZero(0.0); }
  // s that it has not been ENABLED for.
  double notEnabled() const { return now_ - not_enabled_since_; }

  double now_ = 0.0;
  Driver driver_{DriverConfig()};
  sim::Emulator emulator_{sim::EmulatorConfig(), 0.0};
  sim::Wire wire_;
  sim::Faults faults_{emulator_, wire_};

 private:
  int ticks_ = 0;
  bool open_ = true;
  double reopen_ = 0.0;
  double not_enabled_since_ = 0.0;
  double standing_since_ = 0.0;
};

class FaultRun {
 public:
  FaultRun(Cart& cart, const test::FaultScript& script, const scope::Velocity& command)
      : cart_(cart), script_(script), command_(command) {}

  void run() {
    enable();
    if (!testing::Test::HasFatalFailure()) misbehave();
    if (!testing::Test::HasFatalFailure()) recover();
  }
  double longest() const { return longest_; }
  const std::string& reason() const { return reason_; }

 private:
  void enable() {
    ASSERT_TRUE(cart_.until([&] { return cart_.isUp() && !cart_.moves(); }, 5.0));
    ASSERT_EQ(cart_.enable(), "");
    ASSERT_TRUE(cart_.until([&] { return cart_.mode() == OperatingMode::kEnabled; }, 2.0));
    ASSERT_TRUE(cart_.until([&] { return cart_.moves(); }, 2.0, command_)) << cart_.driver_.state(cart_.now_).reason;
    cart_.until([] { return false; }, 0.3, command_);
  }

  void misbehave() {
    const double begin = cart_.now_;
    const double stop = begin + script_.stopsAt() + bounds_.afterArrival() + script_.heldBack() + 2 * kTick;
    for (const sim::ScheduledFault& fault : script_.entries) ASSERT_EQ(cart_.faults_.schedule(fault, begin), "");
    while (cart_.now_ < begin + script_.end() + 2.5) {
      cart_.step(command_);
      watch();
      if (cart_.mode() != OperatingMode::kEnabled && reason_.empty()) reason_ = cart_.driver_.state(cart_.now_).reason;
      ASSERT_FALSE(cart_.moves() && cart_.now_ > stop) << "it moves " << cart_.now_ - begin << " s after the beginning";
    }
  }

  // What holds at any time.
  void watch() {
    const double limit = bounds_.afterSending() + script_.heldBack() + 2 * kTick;
    if (cart_.moves() && cart_.mode() != OperatingMode::kEnabled) longest_ = std::max(longest_, cart_.notEnabled());
    ASSERT_LE(cart_.emulator_.longestMotion(), bounds_.afterArrival() + 2 * kTick);
    ASSERT_LE(longest_, limit) << "it moves, and is " << name(cart_.mode());
    if (script_.misleads()) return;
    const scope::Velocity v =
        scopeVelocity(cart_.driver_.kinematics(), cart_.emulator_.arm().position(), cart_.emulator_.arm().velocity());
    ASSERT_LE(std::abs(v.pan), 1.1 * std::abs(command_.pan) + 0.006);
    ASSERT_LE(std::abs(v.tilt), 1.1 * std::abs(command_.tilt) + 0.006);
    ASSERT_LE(std::abs(v.insertion), 1.1 * std::abs(command_.insertion) + 0.002);
  }

  void recover() {
    cart_.faults_.forget();
    sim::Fault none;
    none.name = "none";
    ASSERT_EQ(cart_.faults_.begin(none, cart_.now_), "");
    ASSERT_TRUE(cart_.until([&] { return cart_.isUp(); }, 3.0, command_)) << "it does not come back";
    cart_.until([] { return false; }, 0.6, command_);
    if (cart_.mode() == OperatingMode::kFault) {
      ASSERT_EQ(cart_.driver_.clearFault(cart_.now_), "");
    } else if (cart_.mode() == OperatingMode::kEnabled) {
      ASSERT_EQ(cart_.driver_.disable(cart_.now_), "");
    }
    ASSERT_TRUE(cart_.until([&] { return cart_.mode() == OperatingMode::kDisabled && !cart_.moves(); }, 1.5, command_));
    const JointVector before = cart_.emulator_.arm().position();
    cart_.until([] { return false; }, 0.5, command_);
    ASSERT_EQ(cart_.emulator_.arm().position(), before) << "it moved without an enable";
    ASSERT_EQ(cart_.mode(), OperatingMode::kDisabled);
  }

  Cart& cart_;
  const test::FaultScript& script_;
  scope::Velocity command_;
  test::StopBounds bounds_;
  double longest_ = 0.0;
  std::string reason_;
};

TEST(FaultRuns, noneMovesTheArmForLongerThanItMay) {
  const int first = setting("AESOP_FAULT_SEED", 1);
  const int count = setting("AESOP_FAULT_RUNS", 300);
  double longest = 0.0;
  int stopped = 0;
  for (int seed = first; seed < first + count; ++seed) {
    test::RandomFaults random(static_cast<unsigned>(seed));
    Cart cart(static_cast<unsigned>(seed));
    const test::FaultScript script = random.draw();
    const scope::Velocity command{random.real(-0.05, 0.05), random.real(-0.05, 0.05), 0.0, 0.0};
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + script.text());
    FaultRun run(cart, script, {command.pan + (command.pan > 0 ? 0.03 : -0.03), command.tilt, 0.0, 0.0});
    run.run();
    longest = std::max(longest, run.longest());
    stopped += run.reason().empty() ? 0 : 1;
    if (std::getenv("AESOP_FAULT_VERBOSE") != nullptr) {
      std::cout << seed << ' ' << run.longest() << " s, '" << run.reason() << "' " << script.text() << std::endl;
    }
    if (HasFatalFailure()) return;
  }
  std::cout << count << " scripts, " << stopped << " of them ended the ENABLED state, longest motion after that "
            << longest << " s" << std::endl;
}

}  // namespace
}  // namespace laparoscope_servo::aesop
