// The error by the homography from messages, and everything that is refused by name.
#include "ros/controller/position_input.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <string>

#include "laparoscope_servo/geometry/homography.h"
#include "unit/ros/controller/feature_inputs.h"

namespace laparoscope_servo {
namespace {

TaskError regionOf(double stamp) {
  TaskError message;
  message.reference_stamp = ros::Time(stamp);
  message.m_star.x = 0.02;
  message.m_star.y = -0.01;
  message.m_star.z = 1.0;
  return message;
}

// The camera has moved by `x` m to the side of tissue that is 0.08 m away.
Homography movedBy(double x, double stamp = 3.0) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translation().x() = -x;
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> h = geometry::fromPlane(motion, Eigen::Vector3d::UnitZ(), 0.08);
  Homography message;
  message.state = Homography::TRACKING;
  message.reference_stamp = ros::Time(stamp);
  message.has_intrinsics = 1;
  std::copy_n(h.data(), 9, message.h.begin());
  message.visible_fraction = 0.9;
  message.corner_error = 0.2;
  return message;
}

TEST(PositionInput, IsTheErrorOfTheRegionByItsHomography) {
  PositionInput position(0.08);
  position.know(regionOf(3.0));
  const servo::TaskErrorInput seen = position.from(movedBy(0.008), depthOf(0.1));
  ASSERT_TRUE(seen.valid) << seen.problem;
  EXPECT_EQ(seen.problem, "");
  EXPECT_NEAR(seen.error.x, 0.02 - 0.1, 1e-9);
  EXPECT_NEAR(seen.error.y, -0.01, 1e-9);
  EXPECT_NEAR(seen.error.log_depth, 0.0, 1e-9);
  EXPECT_EQ(seen.error.desired_x, 0.02);
  EXPECT_EQ(seen.region, 3.0);
  EXPECT_EQ(seen.visible_fraction, 0.9);
  EXPECT_EQ(seen.corner_error, 0.2);
  EXPECT_EQ(implausible(seen), "");
}

TEST(PositionInput, IsNotValidUnlessTheRegionIsTracked) {
  PositionInput position(0.08);
  position.know(regionOf(3.0));
  for (const std::uint8_t state : {Homography::IDLE, Homography::SEARCHING, Homography::LOST}) {
    Homography message = movedBy(0.008);
    message.state = state;
    const servo::TaskErrorInput seen = position.from(message, depthOf(0.1));
    EXPECT_FALSE(seen.valid);
    EXPECT_EQ(seen.problem, "");
  }
}

struct Wrong {
  const char* name;
  std::function<void(Homography&)> apply;
  const char* problem;
};

TEST(PositionInput, RefusesByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Wrong all[] = {
      {"no intrinsics", [](Homography& m) { m.has_intrinsics = 0; }, "no intrinsics"},
      {"another region", [](Homography& m) { m.reference_stamp = ros::Time(4.0); }, "place of the region is not known"},
      {"not a number", [&](Homography& m) { m.h[4] = nan; }, "of no plane"},
      {"zero", [](Homography& m) { m.h.fill(0.0); }, "of no plane"},
  };
  for (const Wrong& wrong : all) {
    PositionInput position(0.08);
    position.know(regionOf(3.0));
    Homography message = movedBy(0.008);
    wrong.apply(message);
    const servo::TaskErrorInput seen = position.from(message, depthOf(0.1));
    EXPECT_FALSE(seen.valid) << wrong.name;
    EXPECT_NE(seen.problem.find(wrong.problem), std::string::npos) << wrong.name << ": " << seen.problem;
  }
}

TEST(PositionInput, NeedsARegionAndTheScope) {
  PositionInput position(0.08);
  EXPECT_NE(position.from(movedBy(0.008), depthOf(0.1)).problem.find("place of the region"), std::string::npos);
  position.know(regionOf(3.0));
  EXPECT_EQ(position.from(movedBy(0.008), servo::DepthInput()).problem, "depth d2 is unknown");
  EXPECT_TRUE(position.from(movedBy(0.008), depthOf(0.1)).valid);
}

// A picture that repeats has to show to the last digit, whatever the noise of the scope's pose.
TEST(PositionInput, ThePosesNoiseIsNotInIt) {
  PositionInput position(0.08);
  position.know(regionOf(3.0));
  const servo::TaskErrorInput first = position.from(movedBy(0.008), depthOf(0.1));
  const servo::TaskErrorInput second = position.from(movedBy(0.008), depthOf(0.1003));
  EXPECT_EQ(first.error.alpha, second.error.alpha);
  EXPECT_EQ(first.error.x, second.error.x);
}

}  // namespace
}  // namespace laparoscope_servo
