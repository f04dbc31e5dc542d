// The view's task error from messages: its value through the lens, and everything that is refused.
#include "ros/controller/view_input.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/motion/motion_model.h"
#include "laparoscope_servo/servo/view_region.h"
#include "support/lens_info.h"

namespace laparoscope_servo {
namespace {

const cv::Size kSize{640, 480};
const geometry::Rectangle kFrame{0.0, 0.0, 640.0, 480.0};
const geometry::PinholeCamera kCamera{500.0, 500.0, 310.0, 250.0};

sensor_msgs::CameraInfo pinhole() {
  sensor_msgs::CameraInfo info;
  info.width = 640;
  info.height = 480;
  info.distortion_model = "plumb_bob";
  info.D.assign(5, 0.0);
  info.K = {kCamera.fx, 0.0, kCamera.cx, 0.0, kCamera.fy, kCamera.cy, 0.0, 0.0, 1.0};
  info.P = {kCamera.fx, 0.0, kCamera.cx, 0.0, 0.0, kCamera.fy, kCamera.cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

// Normalised, of a camera that has panned, turned and come nearer.
Eigen::Matrix3d moved() {
  Eigen::Isometry3d now_T_anchor = Eigen::Isometry3d::Identity();
  now_T_anchor.linear() = geometry::so3Exp({0.03, -0.05, 0.04});
  now_T_anchor.translation() = Eigen::Vector3d(0.002, -0.001, -0.004);
  return geometry::fromPlane(now_T_anchor, Eigen::Vector3d::UnitZ(), 0.08);
}

TrackedFeatures anchored(const Eigen::Matrix3d& g) {
  TrackedFeatures message;
  message.state = TrackedFeatures::TRACKING;
  message.selection_stamp = ros::Time(3, 500000000);
  TrackedFeature motion;
  motion.id = "view";
  motion.kind = TrackedFeature::MOTION;
  motion.state = TrackedFeatures::TRACKING;
  motion.share = 0.8;
  motion.expected_error = 0.05;
  const geometry::Vector8d a = motion::fieldOf(g, kFrame.centre()).a;
  motion.parameters.assign(a.data(), a.data() + 8);
  for (const Eigen::Vector2d& corner : geometry::apply(g, kFrame.corners())) {
    motion.outline.push_back(corner.x());
    motion.outline.push_back(corner.y());
  }
  TrackedFeature step = motion;
  step.id = "view step";
  step.share = 0.6;
  message.features = {motion, step};
  return message;
}

TrackedFeatures anchored() {
  return anchored(geometry::pixelsFromNormalised(moved(), kCamera));
}

FeatureCamera calibrated() {
  FeatureCamera camera(false);
  camera.take(pinhole());
  return camera;
}

TEST(ViewInput, IsTheTaskErrorOfTheViewsMiddle) {
  const servo::TaskErrorInput input = viewInput(anchored(), calibrated());
  EXPECT_EQ(input.problem, "");
  ASSERT_TRUE(input.valid);
  const servo::TaskError expected = servo::taskError(moved(), servo::viewRegion(640.0, 480.0), kCamera);
  EXPECT_NEAR(input.error.x, expected.x, 1e-9);
  EXPECT_NEAR(input.error.y, expected.y, 1e-9);
  EXPECT_NEAR(input.error.log_depth, expected.log_depth, 1e-9);
  EXPECT_NEAR(input.error.alpha, expected.alpha, 1e-9);
  EXPECT_LT(input.error.log_depth, -0.01) << "nearer";
  EXPECT_EQ(input.error.desired_x, expected.desired_x);
  EXPECT_EQ(input.region, 3.5);
  EXPECT_EQ(input.visible_fraction, 0.8);
  EXPECT_EQ(input.corner_error, 0.05);
}

TEST(ViewInput, WithoutTheAnchorInViewTheLastStepSaysWhatIsSeen) {
  TrackedFeatures message = anchored();
  message.features[0].share = 0.0;
  EXPECT_EQ(viewInput(message, calibrated()).visible_fraction, 0.6);
}

// The pixels are those of a lens that bends: the motion of its raw corners gives the pinhole camera's error.
TEST(ViewInput, TakesTheLensOut) {
  const image::Lens lens(test::laparoscope(kSize, 500.0));
  FeatureCamera camera(false);
  camera.take(test_support::lensInfo(lens, kSize));
  const geometry::PinholeCamera& ideal = lens.parameters().rectified;
  const geometry::Rectangle region = servo::viewRegion(640.0, 480.0);
  geometry::Quadrilateral before, after;
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector2d corner = region.corners()[k];
    before[k] = *lens.toRaw(corner);
    after[k] = *lens.toRaw(geometry::apply(geometry::pixelsFromNormalised(moved(), ideal), corner));
  }
  const servo::TaskErrorInput seen = viewInput(anchored(geometry::fromCorners(before, after)), camera);
  ASSERT_TRUE(seen.valid) << seen.problem;
  const servo::TaskError expected = servo::taskError(moved(), region, ideal);
  EXPECT_NEAR(seen.error.x, expected.x, 1e-6);
  EXPECT_NEAR(seen.error.y, expected.y, 1e-6);
  EXPECT_NEAR(seen.error.log_depth, expected.log_depth, 1e-6);
  EXPECT_NEAR(seen.error.alpha, expected.alpha, 1e-6);
}

TEST(ViewInput, ReadsPOfRectifiedImages) {
  sensor_msgs::CameraInfo info = pinhole();
  info.K[0] = info.K[4] = 600.0;
  info.D[0] = -0.3;
  FeatureCamera camera(true);
  camera.take(info);
  EXPECT_NEAR(viewInput(anchored(), camera).error.x,
              servo::taskError(moved(), servo::viewRegion(640.0, 480.0), kCamera).x, 1e-9);
}

TEST(ViewInput, NotTrackedItIsNotValid) {
  for (const std::uint8_t state : {TrackedFeatures::IDLE, TrackedFeatures::SEARCHING, TrackedFeatures::LOST}) {
    TrackedFeatures message = anchored();
    message.features[0].state = state;
    EXPECT_FALSE(viewInput(message, calibrated()).valid) << int{state};
  }
  EXPECT_FALSE(viewInput(TrackedFeatures(), calibrated()).valid);
}

TEST(ViewInput, RefusesByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Bad {
    std::function<void(TrackedFeatures&)> apply;
    const char* problem;
  };
  const Bad all[] = {
      {[](TrackedFeatures& m) { m.features.pop_back(); }, "no image was selected"},
      {[](TrackedFeatures& m) { m.features[1].id = "other"; }, "no image was selected"},
      {[](TrackedFeatures& m) { m.features[0].kind = TrackedFeature::POINT; }, "no image was selected"},
      {[](TrackedFeatures& m) { m.features.resize(3); }, "no image was selected"},
      {[](TrackedFeatures& m) { m.features[0].desired.assign(8, 0.0); }, "desired"},
      {[](TrackedFeatures& m) { m.features[0].parameters.clear(); }, "parameters"},
      {[](TrackedFeatures& m) { m.features[0].parameters.resize(100, 0.0); }, "parameters"},
      {[](TrackedFeatures& m) { m.features[0].outline.resize(7); }, "outline"},
      {[=](TrackedFeatures& m) { m.features[0].parameters[3] = nan; }, "not finite"},
      {[=](TrackedFeatures& m) { m.features[0].outline[0] = nan; }, "another size"},
      {[](TrackedFeatures& m) { m.features[0].outline[2] += 2.0; }, "another size"},
      {[](TrackedFeatures& m) { m.features[0].parameters[6] = 1.0; }, "another size"},
  };
  for (const Bad& bad : all) {
    TrackedFeatures message = anchored();
    bad.apply(message);
    const servo::TaskErrorInput input = viewInput(message, calibrated());
    EXPECT_FALSE(input.valid) << bad.problem;
    EXPECT_NE(input.problem.find(bad.problem), std::string::npos) << input.problem;
  }
}

TEST(ViewInput, NeedsAUsableCalibration) {
  FeatureCamera camera(false);
  EXPECT_NE(viewInput(anchored(), camera).problem.find("no camera_info has come"), std::string::npos);
  sensor_msgs::CameraInfo info = pinhole();
  info.width = info.height = 0;
  camera.take(info);
  EXPECT_NE(viewInput(anchored(), camera).problem.find("no size"), std::string::npos);
  info = pinhole();
  info.K[0] = 0.0;
  camera.take(info);
  EXPECT_NE(viewInput(anchored(), camera).problem.find("camera_info cannot be used"), std::string::npos);
  info = pinhole();
  info.width = 320;
  info.height = 240;
  info.K = {250.0, 0.0, 155.0, 0.0, 250.0, 125.0, 0.0, 0.0, 1.0};
  info.P = {250.0, 0.0, 155.0, 0.0, 0.0, 250.0, 125.0, 0.0, 0.0, 0.0, 1.0, 0.0};
  camera.take(info);
  EXPECT_NE(viewInput(anchored(), camera).problem.find("another size"), std::string::npos);
  camera.take(pinhole());
  EXPECT_TRUE(viewInput(anchored(), camera).valid) << "it is mended by the next one";
}

TEST(FeatureCamera, KnowsAnotherCalibration) {
  FeatureCamera camera(false);
  EXPECT_FALSE(camera.take(pinhole())) << "the first one";
  sensor_msgs::CameraInfo info = pinhole();
  info.header.stamp = ros::Time(5);
  EXPECT_FALSE(camera.take(info)) << "only the header differs";
  info.K[0] += 1.0;
  EXPECT_TRUE(camera.take(info));
}

}  // namespace
}  // namespace laparoscope_servo
