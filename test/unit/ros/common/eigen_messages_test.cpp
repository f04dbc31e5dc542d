#include "ros/common/eigen_messages.h"

#include <gtest/gtest.h>

#include "laparoscope_servo/geometry/se3.h"

namespace laparoscope_servo {
namespace {

Eigen::Isometry3d somewhere() {
  geometry::Vector6d twist;
  twist << 0.1, -0.2, 0.3, 0.4, -0.5, 2.0;
  return geometry::se3Exp(twist);
}

TEST(EigenMessages, TransformsComeBackAsTheyWere) {
  const Eigen::Isometry3d transform = somewhere();
  EXPECT_TRUE(fromMessage(transformMessage(transform)).isApprox(transform, 1e-14));
  const geometry_msgs::Transform message = transformMessage(transform);
  EXPECT_EQ(message.translation.x, transform.translation().x());
  EXPECT_EQ(message.translation.z, transform.translation().z());
  EXPECT_EQ(fromMessage(message.translation), Eigen::Vector3d(transform.translation()));
}

// A turn by 90 degrees about z: (x, y, z, w) in the message's order.
TEST(EigenMessages, QuaternionsAreInTheMessagesOrder) {
  const geometry_msgs::Quaternion message = rotationMessage(geometry::so3Exp({0.0, 0.0, M_PI / 2.0}));
  EXPECT_NEAR(message.x, 0.0, 1e-15);
  EXPECT_NEAR(message.y, 0.0, 1e-15);
  EXPECT_NEAR(message.z, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(message.w, std::sqrt(0.5), 1e-15);
  EXPECT_TRUE((fromMessage(message) * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-14));
}

TEST(EigenMessages, AQuaternionOfAnotherLengthOnlyTurns) {
  geometry_msgs::Transform message = transformMessage(somewhere());
  for (double* element : {&message.rotation.x, &message.rotation.y, &message.rotation.z, &message.rotation.w})
    *element *= 1.005;
  EXPECT_TRUE(fromMessage(message).isApprox(somewhere(), 1e-12));
  EXPECT_NEAR(fromMessage(message).linear().determinant(), 1.0, 1e-12);
}

TEST(EigenMessages, NoQuaternionIsNoRotation) {
  EXPECT_FALSE(fromMessage(geometry_msgs::Transform()).matrix().allFinite());
}

TEST(EigenMessages, PointsAndVectors) {
  const Eigen::Vector3d v(1.0, -2.0, 3.5);
  EXPECT_EQ(fromMessage(vectorMessage(v)), v);
  EXPECT_EQ(pointMessage(v).y, -2.0);
  EXPECT_EQ(pointMessage(v).z, 3.5);
}

}  // namespace
}  // namespace laparoscope_servo
