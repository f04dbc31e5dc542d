#include "ros/joystick/joystick_events.h"

#include <gtest/gtest.h>
#include <linux/joystick.h>

#include <stdexcept>

namespace laparoscope_servo {
namespace {

void add(JoystickEvents& events, int type, int number, int value, std::size_t from = 0, std::size_t to = 8) {
  const js_event event{4711, static_cast<std::int16_t>(value), static_cast<std::uint8_t>(type),
                       static_cast<std::uint8_t>(number)};
  events.add(reinterpret_cast<const std::uint8_t*>(&event) + from, to - from);
}

TEST(JoystickEvents, AreReadInTheirOrder) {
  JoystickEvents events;
  EXPECT_FALSE(events.next());
  add(events, JS_EVENT_BUTTON | JS_EVENT_INIT, 5, 1);
  add(events, JS_EVENT_AXIS, 3, -32767);
  const auto button = events.next();
  ASSERT_TRUE(button);
  EXPECT_EQ(button->kind, JoystickEvent::Kind::kButton);
  EXPECT_TRUE(button->initial);
  EXPECT_EQ(button->number, 5);
  EXPECT_EQ(button->value, 1);
  const auto axis = events.next();
  ASSERT_TRUE(axis);
  EXPECT_EQ(axis->kind, JoystickEvent::Kind::kAxis);
  EXPECT_FALSE(axis->initial);
  EXPECT_EQ(axis->number, 3);
  EXPECT_EQ(axis->value, -32767);
  EXPECT_FALSE(events.next());
}

TEST(JoystickEvents, MayComeInPieces) {
  for (std::size_t cut = 1; cut < 8; ++cut) {
    JoystickEvents events;
    add(events, JS_EVENT_AXIS, 1, 1234, 0, cut);
    EXPECT_FALSE(events.next()) << cut;
    add(events, JS_EVENT_AXIS, 1, 1234, cut, 8);
    const auto event = events.next();
    ASSERT_TRUE(event) << cut;
    EXPECT_EQ(event->value, 1234) << cut;
  }
}

TEST(JoystickEvents, ThatAreNoneEndTheStream) {
  for (const int type : {0, 3, 4, 0x7f, 0x83, 0x80}) {
    JoystickEvents events;
    add(events, type, 0, 1);
    EXPECT_THROW(events.next(), std::runtime_error) << type;
  }
  JoystickEvents events;
  add(events, JS_EVENT_BUTTON, 0, 2);
  EXPECT_THROW(events.next(), std::runtime_error) << "a button is 0 or 1";
  events.add(reinterpret_cast<const std::uint8_t*>("abc"), 3);
  events.clear();
  add(events, JS_EVENT_BUTTON, 0, 1);
  EXPECT_TRUE(events.next()) << "another device begins anew";
}

}  // namespace
}  // namespace laparoscope_servo
