// The controller through random pairs of faults, in simulated time, in each task: CART_FAULT_RUNS of them, from
// CART_FAULT_SEED on; CART_FAULT_VERBOSE prints each. The same is done to the nodes in test/system/cart.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "support/cart_faults.h"
#include "unit/servo/pair_task.h"

namespace laparoscope_servo::servo {
namespace {

using test::CartFault;
using test::ScopeTravel;
using test::SimulatedCart;

constexpr double kDegree = M_PI / 180.0;
constexpr double kMostAngle = 3.0 * kDegree;
// Where a picture is wrong and something else interrupts what shows it.
constexpr double kMostAngleOfPicture = 4.0 * kDegree;
constexpr double kNearer = 0.6;          // of the region's offset, and it is no fault that the scope moved
constexpr double kMostDistance = 0.005;  // m
// rad/s and m/s, by which an arm that is later goes on meanwhile: limits/velocity and the dead zone.
constexpr double kFastestTurn = 0.104, kFastestInsertion = 0.0204;
constexpr double kArmDelay = 0.16 + 0.02;  // s, of the robot, and a step of the controller
constexpr double kNoticed = 0.05;          // s, in which the controller has taken two steps

int setting(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoi(text);
}

ControllerConfig withDeadMan() {
  ControllerConfig config;
  config.safety.dead_man_required = true;
  return config;
}

class PairRun {
 public:
  // `task`: unless it is MANUAL, as a quarter of the runs are. `strangers`: one of the two is a stranger's.
  PairRun(unsigned seed, const PairTask& task, bool strangers)
      : random_(seed),
        strangers_(strangers),
        manual_(random_.whole(4) == 0),
        task_(manual_ ? kManualPairs : task),
        cart_(withDeadMan(),
              {random_.sign() * random_.real(0.08, 0.15), random_.real(-0.1, 0.1), random_.real(-0.1, 0.1),
               random_.real(-0.006, 0.006)},
              seed) {}

  // Why the run is not as it should be; empty when it is.
  std::string run() {
    try {
      begin();
      misbehave();
      recover();
    } catch (const std::runtime_error& failure) {
      return failure.what();
    }
    return "";
  }

  std::string text() const {
    std::string all = task_.name;
    for (const CartFault& fault : faults_) {
      all += "; " + fault.name + ", " + std::to_string(fault.from - begin_) + " to " +
             std::to_string(fault.until - begin_) + " s";
    }
    return all;
  }
  const ScopeTravel& worst() const { return worst_; }
  double away() const { return away_; }  // rad
  const std::string& reason() const { return reason_; }

 private:
  void expect(bool holds, const std::string& otherwise) const {
    if (holds) return;
    std::ostringstream text;
    text << otherwise << ", " << cart_.time() - begin_ << " s after the beginning: " << cart_.output.reason;
    throw std::runtime_error(text.str());
  }

  void engage() {
    cart_.pressed = false;
    cart_.pass(0.1);
    const std::string refusal = cart_.controller.engage(cart_.input());
    expect(refusal.empty(), "it does not engage: " + refusal);
    cart_.pass(0.1);
    expect(cart_.output.state == ControllerState::kArmed, "it does not wait for the switch");
    cart_.pressed = true;
    expect(cart_.until([&] { return cart_.output.state == ControllerState::kServo; }, 0.5),
           "the switch does not lead to SERVO");
  }

  void begin() {
    cart_.interference.input = [this](ControllerInput& input, double) { task_.tell(input); };
    cart_.pass(0.2);
    cart_.controller.select(task_.task);
    engage();
    if (manual_) cart_.manual = {random_.real(-0.1, 0.1), random_.real(-0.1, 0.1), 0.05, 0.0};
    cart_.pass(0.4);
    const auto moves = [&] { return !cart_.velocity().isZero(0.0); };
    expect(cart_.until(moves, task_.until_moving), "it does not begin to move");
    begin_ = cart_.time();
    faults_ = random_.pair(begin_, manual_, strangers_);
    cart_.interference.picture = [this](Eigen::Matrix3d& h) {
      for (const CartFault& fault : faults_) {
        if (fault.lasts(cart_.time()) && fault.interference.picture) fault.interference.picture(h);
      }
    };
    cart_.interference.tracker = [this](TaskErrorInput& seen) {
      for (const CartFault& fault : faults_) {
        if (fault.lasts(cart_.time()) && fault.interference.tracker) fault.interference.tracker(seen);
      }
    };
    cart_.interference.input = [this](ControllerInput& input, double time) {
      for (const CartFault& fault : faults_) {
        if (fault.lasts(time) && fault.interference.input) fault.interference.input(input, time);
      }
      task_.tell(input);
    };
  }

  void misbehave() {
    const double end = std::max(faults_[0].until, faults_[1].until) + 1.0;
    std::vector<bool> lasted(faults_.size(), false);
    while (cart_.time() < end) {
      for (std::size_t k = 0; k < faults_.size(); ++k) {
        const bool lasts = faults_[k].lasts(cart_.time());
        if (lasts && !lasted[k] && faults_[k].begin) faults_[k].begin(cart_);
        if (!lasts && lasted[k] && faults_[k].end) faults_[k].end(cart_);
        lasted[k] = lasts;
      }
      cart_.step();
      watch();
    }
  }

  // Of two faults that have to stop the scope the second may come before the first is noticed, or be noticed only when
  // the first is over: what counts is how far it goes after that.
  void watch() {
    bool must_stand = false;
    int lasting = 0;
    for (const CartFault& fault : faults_) {
      const double since = cart_.time() - fault.from;
      lasting += fault.lasts(cart_.time()) ? 1 : 0;
      must_stand |= fault.stops && fault.lasts(cart_.time());
      const bool begins = since >= 0.0 && since < SimulatedCart::kTick && !cart_.velocity().isZero(0.0);
      const bool ended = cart_.time() >= fault.until && cart_.time() < fault.until + SimulatedCart::kTick;
      if (fault.stops && (begins || ended)) from_.reset();
    }
    for (const CartFault& fault : faults_) {
      if (!fault.needs_somebody || !fault.lasts(cart_.time()) || lasting > 1) continue;
      alone_ += SimulatedCart::kTick;
    }
    must_stand |= alone_ > kNoticed;
    if (!must_stand) {
      from_.reset();
    } else if (!from_) {
      from_ = cart_.pose();
      from_offset_ = cart_.offset();
    } else {
      const ScopeTravel travel = cart_.travel(*from_);
      worst_.angle = std::max(worst_.angle, travel.angle);
      worst_.distance = std::max(worst_.distance, travel.distance);
      // A mirror leaves a motion along its line as it is: the loop goes where it should, and shows nothing.
      const bool nearer = ofPicture() && cart_.offset() < kNearer * from_offset_;
      expect(nearer || travel.angle <= mostAngle(), "it turns too far");
      expect(travel.distance <= faster() * (kMostDistance + later() * kFastestInsertion), "it goes too far");
    }
    watchAside();
    if (cart_.output.state == ControllerState::kServo) {
      moved_until_ = cart_.time();
    } else if (cart_.controller_stalls == 0) {
      reason_ = cart_.output.reason;
      expect(cart_.output.command.vector().isZero(0.0), "it commands a motion outside of SERVO");
      expect(cart_.velocity().isZero(0.0) || cart_.time() - moved_until_ < kArmDelay + later(),
             "it moves outside of SERVO");
    }
  }

  // It may go on to the region in spite of a fault, but not away from it.
  void watchAside() {
    if (manual_) return;
    nearest_ = std::min(nearest_, cart_.aside());
    away_ = std::max(away_, cart_.aside() - nearest_);
    expect(away_ <= mostAngle(), "it goes away from the region");
  }

  bool ofPicture() const { return faults_[0].of_picture || faults_[1].of_picture; }
  double mostAngle() const {
    return faster() * ((ofPicture() ? kMostAngleOfPicture : kMostAngle) + later() * kFastestTurn);
  }
  double later() const { return faults_[0].later + faults_[1].later; }
  double faster() const { return faults_[0].faster * faults_[1].faster; }

  // What the page on what stops the arm says for the worst of them: disengage, release stick and switch, engage, press
  // the switch.
  void recover() {
    cart_.interference = {};
    cart_.interference.input = [this](ControllerInput& input, double) { task_.tell(input); };
    cart_.controller.disengage("for a test");
    const scope::Velocity stick = cart_.manual;
    cart_.manual = {};
    cart_.pass(0.3);
    engage();
    if (manual_) {
      cart_.manual = stick;
      expect(cart_.until([&] { return !cart_.velocity().isZero(0.0); }, 1.0), "it is not moved by hand");
      return;
    }
    expect(cart_.seesRegion(), "the region is out of view");
    const auto is_there = [&] { return cart_.offset() < task_.there; };
    expect(cart_.until(is_there, 20.0), "it does not come back to the region");
  }

  test::RandomCartFaults random_;
  bool strangers_;
  bool manual_;
  PairTask task_;
  SimulatedCart cart_;
  std::vector<CartFault> faults_;
  double begin_ = 0.0;
  double moved_until_ = 0.0;
  double alone_ = 0.0;                     // s, for which a fault that needs somebody lasted while the other did not
  std::optional<Eigen::Isometry3d> from_;  // where the scope was when it had to stop
  double from_offset_ = 0.0;               // px, there
  double nearest_ = std::numeric_limits<double>::infinity();  // rad, of the shaft from its place, since the faults
  double away_ = 0.0;                                         // rad, further than that, at most
  ScopeTravel worst_;
  std::string reason_;
};

// The estimate of the insertion point followed it, by as much as the clock had jumped.
TEST(FaultPairs, ADepthThatCannotBeIsForgottenWithTheJumpOfTheClock) {
  SimulatedCart cart(ControllerConfig(), {0.1, 0.05, 0.0, 0.0}, 1);
  cart.pass(0.5);
  ASSERT_EQ(cart.controller.engage(cart.input()), "");
  cart.pass(0.5);
  cart.interference.input = [](ControllerInput& input, double) {
    input.depth.d2 = -75.0;
    input.time += 71.0;
  };
  cart.pass(0.2);
  EXPECT_EQ(cart.output.state, ControllerState::kFault);
  cart.interference = {};
  cart.pass(0.2);
  cart.controller.disengage("for a test");
  EXPECT_EQ(cart.controller.engage(cart.input()), "");
}

void runPairs(const PairTask& task, bool strangers = false) {
  const int first = setting("CART_FAULT_SEED", 1);
  const int count = setting("CART_FAULT_RUNS", task.runs);
  ScopeTravel worst;
  double away = 0.0;
  int stopped = 0;
  for (int seed = first; seed < first + count; ++seed) {
    PairRun run(static_cast<unsigned>(seed), task, strangers);
    const std::string failure = run.run();
    worst.angle = std::max(worst.angle, run.worst().angle);
    worst.distance = std::max(worst.distance, run.worst().distance);
    away = std::max(away, run.away());
    stopped += run.reason().empty() ? 0 : 1;
    EXPECT_EQ(failure, "") << "seed " << seed << ": " << run.text();
    if (std::getenv("CART_FAULT_VERBOSE") != nullptr) {
      std::cout << "seed " << seed << ": " << run.worst().angle / kDegree << " deg, " << 1e3 * run.worst().distance
                << " mm, away " << run.away() / kDegree << " deg, '" << run.reason() << "'; " << run.text()
                << std::endl;
    }
  }
  std::cout << count << " pairs, " << stopped
            << " of them stopped the scope; the furthest after a fault that has to: " << worst.angle / kDegree
            << " deg, " << 1e3 * worst.distance << " mm; away from the region: " << away / kDegree << " deg"
            << std::endl;
}

class EachTask : public testing::TestWithParam<PairTask> {};

TEST_P(EachTask, NoPairMovesTheScopeFurtherThanItMayAndItGoesOnByTheSteps) {
  runPairs(GetParam());
}

INSTANTIATE_TEST_SUITE_P(FaultPairs, EachTask, testing::ValuesIn(kPairTasks),
                         [](const testing::TestParamInfo<PairTask>& pair) { return std::string(pair.param.name); });

TEST(FaultPairs, NoneOfAStrangerMovesTheScopeFurther) {
  runPairs(kPairTasks[0], true);
}

}  // namespace
}  // namespace laparoscope_servo::servo
