// The scope of a selection: told once it is known, and kept until another selection.
#include "ros/controller/selection_scope.h"

#include <gtest/gtest.h>

#include "unit/ros/controller/feature_inputs.h"

namespace laparoscope_servo {
namespace {

TEST(SelectionScope, IsKeptUntilTheSelectionChanges) {
  SelectionScope scope;
  EXPECT_EQ(scope.of(ros::Time(3.0), depthOf(0.1))->d2, 0.1);
  EXPECT_EQ(scope.of(ros::Time(3.0), depthOf(0.12))->d2, 0.1);
  EXPECT_EQ(scope.of(ros::Time(4.0), depthOf(0.12))->d2, 0.12);
  EXPECT_EQ(scope.of(ros::Time(3.0), depthOf(0.15))->d2, 0.15) << "an earlier one comes anew";
}

TEST(SelectionScope, IsEmptyUntilTheDepthIsKnown) {
  SelectionScope scope;
  servo::DepthInput unknown = depthOf(0.1);
  unknown.problem = "no pose";
  EXPECT_FALSE(scope.of(ros::Time(3.0), unknown));
  EXPECT_FALSE(scope.of(ros::Time(3.0), depthOf(0.0)));
  EXPECT_TRUE(scope.of(ros::Time(3.0), depthOf(0.1)));
  EXPECT_TRUE(scope.of(ros::Time(3.0), unknown)) << "it was known before";
  EXPECT_FALSE(scope.of(ros::Time(4.0), unknown));
}

// Also of the first selection of all, whose stamp is that of none.
TEST(SelectionScope, TakesTheOpticsToo) {
  SelectionScope scope;
  servo::DepthInput depth = depthOf(0.1);
  depth.camera_R_shaft = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_EQ(scope.of(ros::Time(), depth)->camera_R_shaft, depth.camera_R_shaft);
}

}  // namespace
}  // namespace laparoscope_servo
