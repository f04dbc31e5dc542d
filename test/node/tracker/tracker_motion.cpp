// The tracker with robot_motion: follows jumps that tf knows, goes without it when tf is silent, and says so.
#include <gtest/gtest.h>
#include <tf2_ros/transform_broadcaster.h>

#include <chrono>

#include "camera_bench.h"

namespace laparoscope_servo {
namespace {

using test_support::CameraBench;
using test_support::DiagnosticsListener;
using test_support::waitFor;

const geometry::Rectangle kRoi{110.0, 75.0, 100.0, 90.0};
const geometry::PinholeCamera kCamera{300.0, 300.0, 160.0, 120.0};
constexpr double kDepth = 0.08;  // m

// To the side by 15 mm, 56 px, or where it was selected.
Eigen::Isometry3d pose(bool aside) {
  Eigen::Isometry3d base_T_camera = Eigen::Isometry3d::Identity();
  base_T_camera.translation().x() = aside ? 0.015 : 0.0;
  return base_T_camera;
}

Eigen::Matrix3d truth(bool aside) {
  return geometry::pixelsFromPlane(pose(aside).inverse() * pose(false), Eigen::Vector3d::UnitZ(), kDepth, kCamera);
}

class TrackerMotion : public testing::Test {
 protected:
  static ros::Time stampOf(int image) { return ros::Time(1000, 0) + ros::Duration(0.04) * image; }

  void moveArm(const ros::Time& stamp, bool aside) {
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = stamp;
    transform.header.frame_id = "base_of_the_test";
    transform.child_frame_id = "optical_of_the_test";
    transform.transform.translation.x = pose(aside).translation().x();
    transform.transform.rotation.w = 1.0;
    broadcaster_.sendTransform(transform);
  }

  std::string robotMotion() const { return diagnostics_.value("robot motion"); }

  CameraBench bench_{"/"};
  DiagnosticsListener diagnostics_{bench_.node(), "tracker"};
  tf2_ros::TransformBroadcaster broadcaster_;
  const cv::Mat scene_ = test_support::texture(cv::Size(320, 240));
};

TEST_F(TrackerMotion, FollowsJumpsThatTfKnowsAndGoesWithoutWhenItIsSilent) {
  ASSERT_TRUE(bench_.ready());
  const auto view = [&](bool aside) { return test_support::view(scene_, truth(aside)); };
  // At rest, until camera_info and tf have arrived, over connections of their own.
  bench_.publishInfo(kCamera.fx);
  int image = 0;
  ASSERT_TRUE(waitFor([&] {
    moveArm(stampOf(image), false);
    const HomographyConstPtr homography = bench_.track(view(false), stampOf(image++));
    const std::string text = robotMotion();
    return homography && homography->has_intrinsics && text.find("given for ") == 0 && text.find("given for 0 ") != 0;
  })) << diagnostics_.last();

  // tf and images come over two connections: where the jump comes late, tf finds the region again. Nothing else can,
  // see the launch file.
  bool aside = false;
  for (int jump = 0; jump < 6; ++jump) {
    aside = !aside;
    HomographyConstPtr homography;
    ASSERT_TRUE(waitFor([&] {
      moveArm(stampOf(image), aside);
      homography = bench_.track(view(aside), stampOf(image++));
      return homography && homography->state == Homography::TRACKING;
    })) << jump;
    const geometry::Quadrilateral corners = geometry::apply(truth(aside), kRoi.corners());
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(homography->corners[2 * c], corners[c].x(), 0.3);
  }

  // One of a time that time has jumped back from, still on its way then, is not what tf goes on with for ever.
  moveArm(ros::Time::now() + ros::Duration(1000.0), false);
  const auto two_reports_later = std::chrono::steady_clock::now() + std::chrono::milliseconds(2500);
  while (std::chrono::steady_clock::now() < two_reports_later) {
    moveArm(stampOf(image), aside);
    bench_.track(view(aside), stampOf(image++));
  }
  EXPECT_EQ(robotMotion().find("given for "), 0u) << diagnostics_.last();
  EXPECT_NE(robotMotion().find("given for 0 of"), 0u) << diagnostics_.last();

  // tf falls silent while the camera rests, some time after the last jump.
  for (int rest = 0; rest < 5; ++rest, ++image) {
    moveArm(stampOf(image), aside);
    bench_.track(view(aside), stampOf(image));
  }
  ASSERT_TRUE(waitFor([&] {
    const HomographyConstPtr homography = bench_.track(view(aside), stampOf(image++));
    EXPECT_TRUE(homography && homography->state == Homography::TRACKING);
    return robotMotion().find("given for 0 of") == 0 && robotMotion().find("stamps") != std::string::npos;
  })) << diagnostics_.last();
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "tracker_motion_test");
}
