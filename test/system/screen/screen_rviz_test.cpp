// Two panels in one real rviz, each for the cart of a namespace, whose nodes say what the test wants.
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <algorithm>
#include <sstream>

#include "support/ros_tests.h"
#include "system/screen/display_text.h"
#include "system/screen/fake_nodes.h"
#include "system/screen/rviz_process.h"
#include "system/screen/virtual_display.h"

namespace laparoscope_servo {
namespace {

using test_support::hands;

const char* const kConfiguration = R"(Panels:
  - {Class: laparoscope_servo/Laparoscope, Name: Cart of the left, Namespace: left}
  - {Class: laparoscope_servo/Laparoscope, Name: Cart of the right, Namespace: right}
Visualization Manager:
  Class: ""
  Global Options: {Fixed Frame: map, Frame Rate: 15}
  Displays: []
  Tools:
    - Class: rviz/Interact
  Views:
    Current: {Class: rviz/Orbit, Name: Current View}
    Saved: ~
Window Geometry: {Width: 2400, Height: 960, X: 0, Y: 0}
)";

class ScreenRviz : public testing::Test {
 protected:
  // Middles of a word on the display, from the left to the right.
  static std::vector<QPoint> placesOf(const std::string& word) {
    std::istringstream rows(test_support::wordsOnDisplay());
    std::vector<QPoint> places;
    for (std::string row; std::getline(rows, row);) {
      std::istringstream fields(row);
      int skipped = 0, left = 0, top = 0, width = 0, height = 0;
      std::string text;
      for (int k = 0; k < 6; ++k) fields >> skipped;
      double confidence = 0.0;
      if (fields >> left >> top >> width >> height >> confidence >> text && text == word)
        places.emplace_back(left + width / 2, top + height / 2);
    }
    std::sort(places.begin(), places.end(), [](const QPoint& a, const QPoint& b) { return a.x() < b.x(); });
    return places;
  }
  std::vector<QPoint> bothPlacesOf(const std::string& word) {
    std::vector<QPoint> places;
    test_support::RvizProcess::waitFor([&] { return (places = placesOf(word)).size() == 2; });
    return places;
  }

  bool connects() {
    return rviz_.comesUp([this] { return left_.connected() && right_.connected(); });
  }

  test_support::VirtualDisplay display_{"2400x1000"};
  test_support::FakeNodes left_{"left"}, right_{"right"};
  test_support::RvizProcess rviz_{kConfiguration};
};

TEST_F(ScreenRviz, EachPanelShowsAndStopsItsOwnCart) {
  left_.change([](TrackerState&, ControllerState& controller, OperatingState&) {
    controller.state = ControllerState::SERVO;
    controller.reason = "";
  });
  right_.change([](TrackerState&, ControllerState&, OperatingState& robot) {
    robot.state = "FAULT";
    robot.reason = "overcurrent";
  });
  ASSERT_TRUE(connects()) << rviz_.log();
  const std::string read = test_support::readUntil({"Cart of the left", "Cart of the right", "/left", "/right"});
  EXPECT_EQ(test_support::notRead(read, {"Cart of the left", "Cart of the right", "/left", "/right"}), "") << read;
  // The states, in the half of the display where their panel is.
  std::vector<QPoint> servo, fault;
  EXPECT_TRUE(test_support::RvizProcess::waitFor([&] { return (servo = placesOf("SERVO")).size() == 1; }))
      << test_support::textOnDisplay();
  EXPECT_TRUE(test_support::RvizProcess::waitFor([&] { return (fault = placesOf("FAULT")).size() == 1; }))
      << test_support::textOnDisplay();
  const std::vector<QPoint> stop = bothPlacesOf("STOP");
  ASSERT_EQ(stop.size(), 2u) << test_support::textOnDisplay();
  ASSERT_TRUE(!servo.empty() && !fault.empty());
  EXPECT_LT(servo[0].x(), stop[1].x()) << "of the left one";
  EXPECT_GT(fault[0].x(), stop[1].x()) << "of the right one";

  const auto press = [](const QPoint& at) {
    hands("mousemove " + std::to_string(at.x()) + " " + std::to_string(at.y()) + " click 1");
  };
  press(stop[0]);
  EXPECT_TRUE(test_support::RvizProcess::waitFor(
      [&] { return left_.robot_stops == 1 && left_.controller_stops == 1 && left_.disables == 1; }));
  press(stop[1]);
  EXPECT_TRUE(test_support::RvizProcess::waitFor(
      [&] { return right_.robot_stops == 1 && right_.controller_stops == 1 && right_.disables == 1; }));
  EXPECT_EQ(left_.robot_stops, 1);
  EXPECT_EQ(left_.disables, 1);
  // A key has no place, and stops both.
  hands("key Escape");
  EXPECT_TRUE(test_support::RvizProcess::waitFor([&] { return left_.robot_stops == 2 && right_.robot_stops == 2; }));
  const std::vector<QPoint> enable = bothPlacesOf("Enable");
  ASSERT_EQ(enable.size(), 2u) << test_support::textOnDisplay();
  press(enable[1]);
  EXPECT_TRUE(test_support::RvizProcess::waitFor([&] { return right_.enables == 1; }));
  EXPECT_EQ(left_.enables, 0);

  EXPECT_TRUE(rviz_.ends()) << rviz_.log();
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "screen_rviz_test", 4);
}
