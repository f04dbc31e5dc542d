// What stops the arm, one fault after the other on the whole cart: each in the situations that its line names, see
// fault_table.cpp; those of other tasks, in cart_task_faults.test. CART_FAULTS=all tries all situations,
// CART_FAULT_PAIRS=N as many random pairs, from CART_FAULT_SEED on; CART_TIME_LIMIT=S gives it more than 900 s. It
// prints what happened, for doc/what_stops_the_arm.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <sstream>

#include "fault_table.h"
#include "stranger.h"

namespace laparoscope_servo::test {
namespace {

constexpr double kCalm = 0.6;      // s of rest that are taken for standing: longer than the arm's delay
constexpr double kLongCalm = 2.0;  // s, the same where a fault grows: the scope may rest before it shows
constexpr double kWatched = 4.0;   // s; nothing that stops the arm takes so long
constexpr double kGoingOn = 1.5;   // s, for which one that may go on is watched
// degrees/s and mm/s, of the arm at limits/velocity.
constexpr double kFastest = 5.8;
constexpr double kFastestInsertion = 20.0;

struct Case {
  const FaultRow* row;
  Situation situation;
};

std::vector<Case> cases() {
  const bool all = std::getenv("CART_FAULTS") != nullptr;
  std::vector<Case> result;
  const auto add = [&](const std::vector<Situation>& situations) {
    for (const FaultRow& row : faultTable()) {
      for (const Situation situation : situations) {
        const unsigned wanted = row.usually | (all ? row.otherwise : 0U);
        if ((wanted & static_cast<unsigned>(situation)) != 0) result.push_back({&row, situation});
      }
    }
  };
  // One tracker after the other.
  add({Situation::kServo, Situation::kHold, Situation::kManual});
  add({Situation::kPosition});
  add({Situation::kFollow});
  add({Situation::kPoints});
  add({Situation::kParallel});
  return result;
}

bool isServo(Situation situation) {
  return situation != Situation::kHold && situation != Situation::kManual;
}

bool isOneOf(const std::string& words, const std::string& state) {
  std::istringstream stream(words);
  for (std::string word; stream >> word;) {
    if (word == state) return true;
  }
  return false;
}

int setting(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoi(text);
}

bool isFor(const FaultRow& row, Situation situation) {
  return ((row.usually | row.otherwise) & static_cast<unsigned>(situation)) != 0;
}

// A fault from its beginning to its end, also where a test ends before it.
class Trial {
 public:
  Trial(const FaultRow& row, FaultCart& cart) : row_(row), cart_(cart) {
    if (!row.stranger.empty()) stranger_ = std::make_unique<Stranger>(cart.bench, row.stranger, row.says, row.rate);
  }
  ~Trial() {
    stranger_.reset();
    if (begun_) row_.end(cart_);
  }
  Trial(const Trial&) = delete;
  Trial& operator=(const Trial&) = delete;

  void begin() {
    begun_ = true;
    if (stranger_) stranger_->begin();
    row_.begin(cart_);
  }

 private:
  const FaultRow& row_;
  FaultCart& cart_;
  std::unique_ptr<Stranger> stranger_;
  bool begun_ = false;
};

void print(const std::string& fault, Situation situation, const Reaction& r) {
  std::printf("| %-50s | %-6s | %5.2f | %5.2f | %5.2f | %6.2f | %5.2f | %5.2f | %5.2f | %s: %s; robot %s\n",
              fault.c_str(), name(situation), r.travel.degrees, r.travel.millimetres, r.travel.tip, r.stood, r.nearer,
              r.away, r.swing, r.state.c_str(), r.reason.c_str(), r.robot.c_str());
  std::fflush(stdout);
}

// One for all: what a fault leaves behind, the next one would find. It starts with the first test, not without one.
class OneCart : public testing::Environment {
 public:
  static FaultCart& get() {
    if (!instance()) {
      instance() = std::make_unique<FaultCart>();
      std::printf("| %-50s | %-6s | %5s | %5s | %5s | %6s | %5s | %5s | %5s | %s\n", "fault", "in", "deg", "mm", "tip",
                  "s", "near", "away", "swing", "state");
    }
    return *instance();
  }
  void TearDown() override { instance().reset(); }

 private:
  static std::unique_ptr<FaultCart>& instance() {
    static std::unique_ptr<FaultCart> cart;
    return cart;
  }
};

double seconds(const FaultRow& row) {
  if (row.watched > 0.0) return row.watched;
  return row.outcome == Outcome::kStands ? kWatched : kGoingOn;
}

// Whether it does what it was engaged for, in spite of the fault: the scope comes nearer, and does not leave the place
// meanwhile. A scope that was held may go on, too: a fault of the pictures takes the cover away.
bool goesOn(const FaultRow& row, Situation situation, const Reaction& r) {
  if (row.outcome == Outcome::kStands) return false;
  if (situation == Situation::kManual)
    return r.state == "SERVO" && r.travel.degrees < 1.2 * kStick * r.lasted * 180.0 / M_PI;
  if (r.away > row.degrees) return false;
  if (r.state == "SERVO") return r.nearer >= 0.0;
  return row.outcome == Outcome::kEither && r.nearer > 0.0;
}

// On a busy machine images come late, and the scope is held for as long. That is not the fault's doing, and it goes on.
void awaitServo(FaultCart& cart, Reaction& r) {
  if (r.state != "HOLD") return;
  cart.bench.waitFor([&] { return !cart.stateIs("HOLD"); }, kWatched);
  r.state = cart.state();
  r.reason = cart.reason();
}

class CartFaults : public testing::TestWithParam<Case> {};

TEST_P(CartFaults, LeaveTheArmWhereItIsOrToItsTask) {
  const FaultRow& row = *GetParam().row;
  const Situation situation = GetParam().situation;
  FaultCart& cart = OneCart::get();
  Trial trial(row, cart);
  ASSERT_EQ(cart.bringTo(situation), "");
  cart.mark();
  trial.begin();
  Reaction reaction = cart.watch(seconds(row), seconds(row) > kWatched ? kLongCalm : kCalm);
  if (row.outcome == Outcome::kGoesOn && isServo(situation)) awaitServo(cart, reaction);
  print(row.name, situation, reaction);
  if (!row.bounded && goesOn(row, situation, reaction)) return;
  EXPECT_FALSE(row.outcome == Outcome::kGoesOn && isServo(situation)) << reaction.nearer << " degrees nearer";
  EXPECT_LT(reaction.stood, std::max(kWatched, seconds(row)) - kCalm) << "it goes on";
  EXPECT_LE(reaction.travel.degrees, row.degrees);
  EXPECT_LE(reaction.travel.millimetres, row.millimetres);
  EXPECT_TRUE(row.states.empty() || isOneOf(row.states, reaction.state)) << reaction.state;
}

// The second begins up to 0.3 s after the first. What one of them stops stands, whatever the other does; where both do,
// the second may come before the first is noticed: what counts is how far the arm goes after that one.
void tryPair(FaultCart& cart, unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&](std::size_t count) { return random() % count; };
  const Situation situation =
      std::array{Situation::kServo, Situation::kServo, Situation::kHold, Situation::kManual}[draw(4)];
  std::vector<const FaultRow*> rows;
  while (rows.size() < 2) {
    const FaultRow& row = faultTable()[draw(faultTable().size())];
    if (isFor(row, situation) && (rows.empty() || rows[0] != &row)) rows.push_back(&row);
  }
  const std::string both = std::to_string(seed) + ": " + rows[0]->name + " + " + rows[1]->name;
  SCOPED_TRACE(both + " in " + name(situation));
  Trial first(*rows[0], cart), second(*rows[1], cart);
  ASSERT_EQ(cart.bringTo(situation), "");
  cart.mark();
  first.begin();
  const bool stops = rows[0]->outcome == Outcome::kStands;
  cart.bench.waitFor([] { return false; }, 0.1 * static_cast<double>(draw(4)));
  if (rows[1]->outcome == Outcome::kStands) cart.mark();
  second.begin();
  const Reaction reaction = cart.watch(kWatched, kCalm);
  print(both, situation, reaction);
  if (!stops && rows[1]->outcome != Outcome::kStands) return;
  EXPECT_LT(reaction.stood, kWatched - kCalm) << "it goes on";
  const double later = rows[0]->later + rows[1]->later;
  EXPECT_LE(reaction.travel.degrees, std::max(rows[0]->degrees, rows[1]->degrees) + later * kFastest);
  EXPECT_LE(reaction.travel.millimetres,
            std::max(rows[0]->millimetres, rows[1]->millimetres) + later * kFastestInsertion);
}

TEST(CartFaultPairs, AreNoWorse) {
  const int first = setting("CART_FAULT_SEED", 1);
  for (int seed = first; seed < first + setting("CART_FAULT_PAIRS", 4); ++seed) {
    tryPair(OneCart::get(), static_cast<unsigned>(seed));
  }
}

std::string nameOf(const testing::TestParamInfo<Case>& info) {
  std::string text = std::string(name(info.param.situation)) + "_" + info.param.row->name;
  for (char& c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return text;
}

void PrintTo(const Case& tried, std::ostream* stream) {
  *stream << tried.row->name << " in " << name(tried.situation);
}

INSTANTIATE_TEST_SUITE_P(Cart, CartFaults, testing::ValuesIn(cases()), nameOf);

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "stranger") return laparoscope_servo::test::runStranger(argc, argv);
  testing::AddGlobalTestEnvironment(new laparoscope_servo::test::OneCart);
  return laparoscope_servo::test::runBenchTests(argc, argv, "cart_faults_test");
}
