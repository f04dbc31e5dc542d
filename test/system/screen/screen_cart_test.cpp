// The screen's window in front of the simulated cart: from the first picture to the stop, by mouse alone.
#include <laparoscope_servo/ScopeVelocity.h>

#include <atomic>
#include <cmath>

#include "system/screen/display_text.h"
#include "system/screen/screen_fixture.h"

namespace laparoscope_servo {
namespace {

using test_support::waitFor;

class ScreenCart : public test_support::ScreenFixture {};

TEST_F(ScreenCart, SelectsEnablesEngagesAndStops) {
  ros::NodeHandle node;
  std::atomic<int> zeros{0};
  const ros::Subscriber commands =
      node.subscribe<ScopeVelocity>("servo_command", 10, [&](const ScopeVelocityConstPtr& command) {
        const bool zero =
            command->pan == 0.0 && command->tilt == 0.0 && command->spin == 0.0 && command->insertion == 0.0;
        zeros = zero ? zeros + 1 : 0;
      });
  show({1280, 800});
  ASSERT_TRUE(waitFor([this] { return word("Tracker") == "IDLE" && isColoured(); }, 90.0)) << word("Tracker");
  ASSERT_TRUE(waitFor([this] { return word("Robot") == "DISABLED" && word("Controller") == "IDLE"; }));
  const QSize shown = image().size();
  ASSERT_TRUE(selects(image().mapToGlobal(QPoint(shown.width() * 2 / 5, shown.height() * 2 / 5)),
                      image().mapToGlobal(QPoint(shown.width() * 3 / 5, shown.height() * 3 / 5))))
      << word("Tracker") << ": " << find<QLabel>("answer").text().toStdString();
  click("enable");
  ASSERT_TRUE(waitFor([this] { return word("Robot") == "ENABLED"; })) << word("Robot");
  click("engage");
  ASSERT_TRUE(waitFor([this] { return word("Controller") == "SERVO"; })) << word("Controller");
  std::string text;
  EXPECT_TRUE(waitFor([&] {
    text = test_support::textOnDisplay();
    return test_support::notRead(text, {"TRACKING", "SERVO", "ENABLED", "STOP"}).empty();
  })) << test_support::notRead(text, {"TRACKING", "SERVO", "ENABLED", "STOP"})
      << " cannot be read:\n"
      << text;
  click("stop");
  EXPECT_TRUE(waitFor([this] { return word("Robot") == "DISABLED" && word("Controller") != "SERVO"; }))
      << word("Robot") << word("Controller");
  zeros = 0;
  EXPECT_TRUE(waitFor([&] { return zeros >= 5; }));
}

// Nothing tells the motion of the view here: the task can be selected, but not engaged, and the screen says why.
TEST_F(ScreenCart, ATaskWhoseInputIsMissingIsNotEngagedAndSaysWhy) {
  show({1280, 800});
  ASSERT_TRUE(waitFor([this] { return word("Robot") == "DISABLED" && word("Controller") == "IDLE"; }, 90.0));
  click("stabilise");
  ASSERT_TRUE(waitFor([this] { return find<screen::StateBand>("Controller").text().note == "Task: Stabilise"; }));
  click("enable");
  ASSERT_TRUE(waitFor([this] { return word("Robot") == "ENABLED"; })) << word("Robot");
  click("engage");
  const auto answer = [this] { return find<QLabel>("answer").text(); };
  EXPECT_TRUE(waitFor([&] {
    return answer().startsWith("Engage: REFUSED.") && answer().contains("no motion of the view was received") &&
           answer().contains("cart.launch motion:=true");
  })) << answer().toStdString();
  click("stop");
  EXPECT_TRUE(waitFor([this] { return word("Robot") == "DISABLED"; }));
  click("hold_region");
  EXPECT_TRUE(waitFor([this] { return find<screen::StateBand>("Controller").text().note == "Task: Hold region"; }));
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runScreenTests(argc, argv, "screen_cart_test");
}
