#include "ros/simulation/scene_markers.h"

#include <gtest/gtest.h>

namespace laparoscope_servo {
namespace {

using visualization_msgs::Marker;

Eigen::Isometry3d poseOf(const Marker& marker) {
  const auto& p = marker.pose.position;
  const auto& q = marker.pose.orientation;
  return Eigen::Translation3d(p.x, p.y, p.z) * Eigen::Quaterniond(q.w, q.x, q.y, q.z);
}

Eigen::Vector3d vector(const geometry_msgs::Point& p) {
  return {p.x, p.y, p.z};
}

TEST(CylinderMarker, ReachesFromOnePointToTheOther) {
  for (const Eigen::Vector3d& b : {Eigen::Vector3d(0.0, 0.0, -0.4), Eigen::Vector3d(0.3, 0.1, 0.2)}) {
    const Eigen::Vector3d a(0.1, -0.2, 0.05);
    const Marker marker = cylinderMarker("base", "x", 3, a, b, 0.01);
    EXPECT_EQ(marker.action, Marker::ADD);
    EXPECT_NEAR(marker.scale.x, 0.02, 1e-12);
    EXPECT_TRUE((poseOf(marker) * Eigen::Vector3d(0.0, 0.0, marker.scale.z / 2.0)).isApprox(b, 1e-9));
    EXPECT_TRUE((poseOf(marker) * Eigen::Vector3d(0.0, 0.0, -marker.scale.z / 2.0)).isApprox(a, 1e-9));
  }
  EXPECT_EQ(cylinderMarker("base", "x", 3, {1.0, 1.0, 1.0}, {1.0, 1.0, 1.0}, 0.01).action, Marker::DELETE);
}

TEST(TissueMarker, IsACentredMeshOfTheTexturesSizeThatFacesTheCamera) {
  const cv::Mat texture(200, 400, CV_8UC3, cv::Scalar(0, 0, 255));
  const Marker marker = tissueMarker("base", Eigen::Isometry3d::Identity(), texture, 0.3);
  ASSERT_EQ(marker.points.size() % 3, 0U);
  ASSERT_EQ(marker.points.size(), marker.colors.size());
  Eigen::Vector3d least(1.0, 1.0, 1.0), most(-1.0, -1.0, -1.0);
  for (std::size_t k = 0; k < marker.points.size(); k += 3) {
    const Eigen::Vector3d a = vector(marker.points[k]), b = vector(marker.points[k + 1]),
                          c = vector(marker.points[k + 2]);
    EXPECT_LT((b - a).cross(c - a).z(), 0.0);
    least = least.cwiseMin(a).cwiseMin(b).cwiseMin(c);
    most = most.cwiseMax(a).cwiseMax(b).cwiseMax(c);
  }
  EXPECT_TRUE(least.isApprox(Eigen::Vector3d(-0.15, -0.075, 0.0), 1e-9)) << least.transpose();
  EXPECT_TRUE(most.isApprox(Eigen::Vector3d(0.15, 0.075, 0.0), 1e-9)) << most.transpose();
  EXPECT_NEAR(marker.colors[0].r, 1.0, 1e-6);
  EXPECT_NEAR(marker.colors[0].b, 0.0, 1e-6);
}

TEST(ViewMarker, EndsAtTheImagesCornersAtTheDepth) {
  const geometry::PinholeCamera camera{100.0, 100.0, 49.5, 29.5};
  const Marker marker = viewMarker("optical", camera, {100, 60}, 0.2);
  double right = 0.0;
  for (const auto& point : marker.points) {
    EXPECT_TRUE(point.z == 0.0 || std::abs(point.z - 0.2) < 1e-12);
    right = std::max(right, point.x);
  }
  EXPECT_NEAR(right, 0.2 * 50.0 / 100.0, 1e-12);
}

}  // namespace
}  // namespace laparoscope_servo
