// Gains that change while the scope moves.
#include <limits>

#include "controller_fixture.h"
#include "support/reconfigure_client.h"

namespace laparoscope_servo {
namespace {

using test_support::ReconfigureClient;

const std::string kCentre = "features__centre";
constexpr double kCentreDefault = 8.0;

class ControllerReconfigure : public ControllerFixture {
 protected:
  static ReconfigureClient& client() {
    static ReconfigureClient instance("/controller");
    return instance;
  }
  void SetUp() override {
    ControllerFixture::SetUp();
    ASSERT_EQ(client().set(kCentre, kCentreDefault), "");
    ASSERT_TRUE(waitFor([] { return client().updated(kCentre) == kCentreDefault; }));
  }
  // Nothing of it counts, and everybody is told what does.
  void expectRefused(const std::function<void(dynamic_reconfigure::Config&)>& fill) {
    const int updates = client().updates();
    EXPECT_EQ(client().set(fill), "refused");
    EXPECT_TRUE(waitFor([&] { return client().updates() > updates; }));
    EXPECT_EQ(client().updated(kCentre), kCentreDefault);
    EXPECT_EQ(client().stored("features/centre"), kCentreDefault);
  }
};

TEST_F(ControllerReconfigure, TellsWhatMayChange) {
  ASSERT_TRUE(waitFor([] { return !client().types().empty(); }));
  const auto types = client().types();
  EXPECT_EQ(types.at(kCentre), "double");
  EXPECT_EQ(types.count("gains__pan"), 1u);
  EXPECT_EQ(types.count("rest__centre_stop"), 1u);
  for (const auto& [name, type] : types) {
    EXPECT_NE(name.rfind("safety", 0), 0u) << name;
    EXPECT_NE(name.rfind("limits", 0), 0u) << name;
  }
}

TEST_F(ControllerReconfigure, WhatIsAcceptedIsAnsweredPublishedAndStored) {
  ASSERT_EQ(client().set(kCentre, 2.5), "");
  EXPECT_EQ(client().answered(kCentre), 2.5);
  EXPECT_TRUE(waitFor([] { return client().updated(kCentre) == 2.5; }));
  EXPECT_TRUE(waitFor([] { return client().stored("features/centre") == 2.5; }));
  EXPECT_EQ(client().set([](dynamic_reconfigure::Config&) {}), "") << "nothing is asked for";
  EXPECT_EQ(client().answered(kCentre), 2.5);
}

TEST_F(ControllerReconfigure, IsRefusedAsAWhole) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [name, value] : {std::pair<std::string, double>("features__depth", kNan),
                                    {"features__depth", -1.0},
                                    {"features__depth", 20.1},
                                    {"features__dept", 1.0},
                                    {"", 1.0},
                                    {"safety__max_task_error_age", 0.5},
                                    {"limits__velocity__pan", 0.05},
                                    {"range__max_depth", 0.2},
                                    {"predictor__delay", 0.1},
                                    {"rate", 50.0},
                                    {"rest__centre_stop", 0.09}}) {  // above rest/centre_start
    SCOPED_TRACE(name + " = " + std::to_string(value));
    expectRefused([name = name, value = value](dynamic_reconfigure::Config& config) {
      ReconfigureClient::add(config, kCentre, 3.0);
      ReconfigureClient::add(config, name, value);
    });
  }
}

TEST_F(ControllerReconfigure, AGainCountsWhileTheScopeMovesAndNothingJumps) {
  engageAndMove();
  const std::vector<ScopeVelocity> before = cart_.nextCommands(10);
  ASSERT_FALSE(before.empty());
  std::vector<ScopeVelocity> all = {before.back()};
  for (const double gain : {0.0, 20.0, 0.0}) {
    ASSERT_EQ(client().set([gain](dynamic_reconfigure::Config& config) {
      for (const char* name : {"features__centre", "features__depth", "features__orientation"})
        ReconfigureClient::add(config, name, gain);
    }),
              "");
    EXPECT_TRUE(waitFor([&] {
      const std::vector<ScopeVelocity> commands = cart_.takeCommands();
      all.insert(all.end(), commands.begin(), commands.end());
      return !commands.empty() && isZero(commands.back()) == (gain == 0.0);
    })) << gain;
    EXPECT_EQ(cart_.state().state, ControllerState::SERVO) << cart_.state().reason;
  }
  // A period counts for max_period, 0.1 s, at most: a machine that is late may take a longer step.
  for (std::size_t k = 1; k < all.size(); ++k) {
    EXPECT_LE(std::abs(all[k].pan - all[k - 1].pan), 0.1 + 1e-9) << k;
    EXPECT_LE(std::abs(all[k].pan), 0.1 + 1e-9) << k;
  }
  ASSERT_EQ(client().set([](dynamic_reconfigure::Config& config) {
    for (const char* name : {"features__centre", "features__depth", "features__orientation"})
      ReconfigureClient::add(config, name, kCentreDefault);
  }),
            "");
}

TEST_F(ControllerReconfigure, WhatWasSetDoesNotEngage) {
  ASSERT_EQ(client().set(kCentre, 20.0), "");
  EXPECT_TRUE(cart_.stands());
  EXPECT_EQ(cart_.state().state, ControllerState::IDLE);
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "controller_reconfigure");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
