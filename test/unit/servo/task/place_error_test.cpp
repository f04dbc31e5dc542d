#include "laparoscope_servo/servo/place_error.h"

#include <gtest/gtest.h>

#include "laparoscope_servo/servo/task_error_input.h"

namespace laparoscope_servo::servo {
namespace {

TEST(PlaceError, TellsWhereItIsAndWhereItShallBe) {
  const TaskError error = placeError({0.3, -0.2}, {0.05, 0.1});
  EXPECT_EQ(error.x, 0.3);
  EXPECT_EQ(error.y, -0.2);
  EXPECT_EQ(error.desired_x, 0.05);
  EXPECT_EQ(error.desired_y, 0.1);
  EXPECT_EQ(error.m_star, Eigen::Vector3d(0.05, 0.1, 1.0)) << "where it is in the reference";
}

// A place has neither depth nor orientation: nothing of them is to be controlled, and nothing for the paper's law.
TEST(PlaceError, AsksForNoDepthAndNoTurn) {
  const TaskError error = placeError({0.3, -0.2}, {0.05, 0.1});
  EXPECT_EQ(error.log_depth, error.desired_log_depth);
  EXPECT_EQ(error.alpha, error.desired_alpha);
  EXPECT_EQ(error.e_v, Eigen::Vector3d::Zero());
  EXPECT_EQ(error.e_w, Eigen::Vector3d::Zero());
}

TEST(PlaceError, IsPlausibleWithinTheImageAndPassesOnWhatIsNot) {
  TaskErrorInput input;
  input.visible_fraction = 1.0;
  input.corner_error = 0.1;
  input.error = placeError({0.9, -0.9}, {0.0, 0.0});
  EXPECT_EQ(implausible(input), "");
  input.error = placeError({std::nan(""), 0.0}, {0.0, 0.0});
  EXPECT_EQ(implausible(input), "task error is not finite");
  input.error = placeError({0.0, 0.0}, {0.0, 6.0});
  EXPECT_NE(implausible(input), "");
}

}  // namespace
}  // namespace laparoscope_servo::servo
