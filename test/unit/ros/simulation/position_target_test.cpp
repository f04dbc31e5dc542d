#include "ros/simulation/position_target.h"

#include <gtest/gtest.h>
#include <visualization_msgs/Marker.h>

#include <algorithm>
#include <cmath>

#include "laparoscope_servo/geometry/se3.h"
#include "ros/common/eigen_messages.h"

namespace laparoscope_servo {
namespace {

using visualization_msgs::Marker;

const geometry::PinholeCamera kCamera{400.0, 400.0, 319.5, 239.5};
const cv::Size kSize(640, 480);
constexpr double kDepth = 0.08;

// The camera goes along the base's x by a centimetre a second, from 100 s on, turned about z.
Eigen::Isometry3d poseAt(double time) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(0.01 * (time - 100.0), 0.2, 0.3);
  pose.linear() = geometry::so3Exp({0.0, 0.0, 0.5});
  return pose;
}

class PositionTargetTest : public testing::Test {
 protected:
  void tell(double time) {
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = ros::Time(time);
    transform.header.frame_id = "base";
    transform.child_frame_id = "camera";
    transform.transform = transformMessage(poseAt(time));
    tf_.setTransform(transform, "test");
  }
  // A region of 100 x 60 px at (200, 150) that was selected then and is seen 30 px further to the right by now.
  void see(double selected, std::uint8_t state = Homography::TRACKING) {
    Homography message;
    message.state = state;
    message.reference_stamp = ros::Time(selected);
    message.g = {1.0, 0.0, 30.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    message.corners = {230.0, 150.0, 330.0, 150.0, 330.0, 210.0, 230.0, 210.0};
    target_.take(message, tf_);
  }
  visualization_msgs::MarkerArray markers(bool wanted = true) const {
    visualization_msgs::MarkerArray array;
    target_.addTo(array, wanted, kCamera, kSize, kDepth, Eigen::Vector3d(1.0, 2.0, 3.0));
    return array;
  }
  bool isDrawn(bool wanted = true) const {
    const auto array = markers(wanted);
    EXPECT_EQ(array.markers.size(), 3U);
    const auto isAdded = [](const Marker& m) { return m.action == Marker::ADD; };
    const bool any = std::any_of(array.markers.begin(), array.markers.end(), isAdded);
    EXPECT_EQ(any, std::all_of(array.markers.begin(), array.markers.end(), isAdded));
    return any;
  }

  tf2::BufferCore tf_;
  PositionTarget target_{"base", "camera"};
};

TEST_F(PositionTargetTest, IsWhereTheCameraWasWhenTheRegionWasSelected) {
  for (const double time : {100.0, 101.0, 102.0}) tell(time);
  see(100.5);
  ASSERT_TRUE(isDrawn());
  const auto array = markers();
  const Eigen::Isometry3d then = poseAt(100.5);
  for (std::size_t k = 0; k < 2; ++k) {
    const Marker& m = array.markers[k];
    EXPECT_EQ(m.header.frame_id, "base");
    EXPECT_NEAR(m.pose.position.x, then.translation().x(), 1e-9);
    EXPECT_NEAR(m.pose.position.z, then.translation().z(), 1e-9);
    EXPECT_NEAR(m.pose.orientation.z, std::sin(0.25), 1e-9);
  }
  // The outline as it was seen then, closed, at the depth at which the view ends.
  const Marker& outline = array.markers[1];
  ASSERT_EQ(outline.points.size(), 5U);
  EXPECT_NEAR(outline.points[0].x, kDepth * (200.0 - 319.5) / 400.0, 1e-9);
  EXPECT_NEAR(outline.points[0].y, kDepth * (150.0 - 239.5) / 400.0, 1e-9);
  EXPECT_NEAR(outline.points[2].x, kDepth * (300.0 - 319.5) / 400.0, 1e-9);
  EXPECT_NEAR(outline.points[2].z, kDepth, 1e-9);
  EXPECT_EQ(outline.points[4].x, outline.points[0].x);
  // The way there, in the base.
  const Marker& way = array.markers[2];
  ASSERT_EQ(way.points.size(), 2U);
  EXPECT_EQ(way.points[0].y, 2.0);
  EXPECT_NEAR(way.points[1].x, then.translation().x(), 1e-9);
}

TEST_F(PositionTargetTest, IsDrawnWhileItIsWantedOnly) {
  tell(100.0), tell(101.0);
  EXPECT_FALSE(isDrawn()) << "nothing is selected";
  see(100.5);
  EXPECT_TRUE(isDrawn());
  EXPECT_FALSE(isDrawn(false));
  see(100.5, Homography::IDLE);
  EXPECT_FALSE(isDrawn());
}

// An image comes before tf has a pose for it.
TEST_F(PositionTargetTest, WaitsForThePoseOfTheSelection) {
  tell(100.0);
  see(100.5);
  EXPECT_FALSE(isDrawn());
  tell(101.0);
  see(100.5, Homography::SEARCHING);
  EXPECT_TRUE(isDrawn());
}

TEST_F(PositionTargetTest, AnotherSelectionHasAnotherTarget) {
  tell(100.0), tell(102.0);
  see(100.5);
  see(101.5);
  ASSERT_TRUE(isDrawn());
  EXPECT_NEAR(markers().markers[0].pose.position.x, 0.015, 1e-9);
  see(99.0);
  EXPECT_FALSE(isDrawn()) << "tf does not reach back to it";
}

}  // namespace
}  // namespace laparoscope_servo
