#include "model/instrument/axis_meeting.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo::model {
namespace {

const Eigen::Vector2d kTrocar(900.0, 350.0);

// An axis through the trocar, seen `distance` px from it.
void add(AxisMeeting& meeting, double angle, double aside = 0.0, double distance = 400.0) {
  const Eigen::Vector2d direction(std::cos(angle), std::sin(angle)), side(-direction.y(), direction.x());
  meeting.add(kTrocar - distance * direction + aside * side, direction);
}

TEST(AxisMeeting, AxesThatTurnMeetInTheTrocar) {
  AxisMeeting meeting;
  for (int k = 0; k < 60; ++k) add(meeting, 0.2 * std::sin(0.2 * k), 0.5 * std::cos(1.7 * k));
  ASSERT_TRUE(meeting.point());
  EXPECT_LT((*meeting.point() - kTrocar).norm(), 3.0);
}

TEST(AxisMeeting, AnAxisThatDoesNotTurnTellsNothing) {
  AxisMeeting meeting;
  for (int k = 0; k < 200; ++k) add(meeting, 0.3);
  EXPECT_FALSE(meeting.point());
}

TEST(AxisMeeting, AFewImagesTellNothing) {
  AxisMeeting meeting;
  for (int k = 0; k < 10; ++k) add(meeting, 0.05 * k);
  EXPECT_FALSE(meeting.point());
}

TEST(AxisMeeting, AxesThatMeetNowhereTellNothing) {
  AxisMeeting meeting;
  for (int k = 0; k < 100; ++k) add(meeting, 0.2 * std::sin(0.2 * k), 30.0 * std::cos(1.7 * k));
  EXPECT_FALSE(meeting.point());
}

TEST(AxisMeeting, ResetForgets) {
  AxisMeeting meeting;
  for (int k = 0; k < 60; ++k) add(meeting, 0.2 * std::sin(0.2 * k));
  meeting.reset();
  EXPECT_FALSE(meeting.point());
}

}  // namespace
}  // namespace laparoscope_servo::model
