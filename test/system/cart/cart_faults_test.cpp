// What stops the arm, one fault after the other on the whole cart: each in the situations that its line names, see
// fault_table.cpp. CART_FAULTS=all tries all situations. It prints what happened, for doc/what_stops_the_arm.md.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "fault_table.h"
#include "stranger.h"

namespace laparoscope_servo::test {
namespace {

constexpr double kCalm = 0.6;     // s of rest that are taken for standing: longer than the arm's delay
constexpr double kWatched = 4.0;  // s; nothing that stops the arm takes so long

struct Case {
  const FaultRow* row;
  Situation situation;
};

std::vector<Case> cases() {
  const bool all = std::getenv("CART_FAULTS") != nullptr;
  std::vector<Case> result;
  for (const FaultRow& row : faultTable()) {
    for (const Situation situation : {Situation::kServo, Situation::kHold, Situation::kManual}) {
      const unsigned wanted = row.usually | (all ? row.otherwise : 0U);
      if ((wanted & static_cast<unsigned>(situation)) != 0) result.push_back({&row, situation});
    }
  }
  return result;
}

bool isOneOf(const std::string& words, const std::string& state) {
  std::istringstream stream(words);
  for (std::string word; stream >> word;) {
    if (word == state) return true;
  }
  return false;
}

std::unique_ptr<FaultCart>& cart() {
  static std::unique_ptr<FaultCart> instance;
  return instance;
}

class CartFaults : public testing::TestWithParam<Case> {
 protected:
  static void SetUpTestSuite() {
    cart() = std::make_unique<FaultCart>();
    std::printf("| %-50s | %-6s | %5s | %5s | %5s | %6s | %s\n", "fault", "in", "deg", "mm", "tip", "s", "state");
  }
  static void TearDownTestSuite() { cart().reset(); }

  void print(const Reaction& r) const {
    std::printf("| %-50s | %-6s | %5.2f | %5.2f | %5.2f | %6.2f | %s: %s; robot %s\n", GetParam().row->name.c_str(),
                name(GetParam().situation), r.travel.degrees, r.travel.millimetres, r.travel.tip, r.stood,
                r.state.c_str(), r.reason.c_str(), r.robot.c_str());
    std::fflush(stdout);
  }
};

TEST_P(CartFaults, LeaveTheArmWhereItIsOrToItsTask) {
  const FaultRow& row = *GetParam().row;
  FaultCart& cart = *test::cart();
  std::unique_ptr<Stranger> stranger;
  if (!row.stranger.empty()) stranger = std::make_unique<Stranger>(cart.bench, row.stranger, row.says, row.rate);
  ASSERT_EQ(cart.bringTo(GetParam().situation), "");
  cart.mark();
  if (stranger) stranger->begin();
  row.begin(cart);
  const bool may_go_on = row.outcome != Outcome::kStands && GetParam().situation == Situation::kServo;
  const Reaction reaction = cart.watch(may_go_on ? 1.5 : kWatched, kCalm);
  print(reaction);
  const bool goes_on =
      may_go_on && reaction.nearer > 0.0 && (reaction.state == "SERVO" || row.outcome == Outcome::kEither);
  if (!goes_on) {
    EXPECT_NE(row.outcome, Outcome::kGoesOn) << reaction.nearer << " degrees nearer";
    EXPECT_LT(reaction.stood, kWatched - kCalm) << "it goes on";
    EXPECT_LE(reaction.travel.degrees, row.degrees);
    EXPECT_LE(reaction.travel.millimetres, row.millimetres);
    EXPECT_TRUE(row.states.empty() || isOneOf(row.states, reaction.state)) << reaction.state;
  }
  stranger.reset();
  row.end(cart);
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
  return laparoscope_servo::test::runBenchTests(argc, argv, "cart_faults_test");
}
