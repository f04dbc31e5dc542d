#include "ros/tracker/robot_motion.h"

#include <gtest/gtest.h>

#include <limits>

#include "ros/tracker/tracker_session.h"
#include "support/synthetic_sequence.h"

namespace laparoscope_servo {
namespace {

using tracking::State;

const cv::Size kSize(320, 240);
const geometry::Rectangle kRoi{110.0, 75.0, 100.0, 90.0};
const geometry::PinholeCamera kCamera{300.0, 300.0, 160.0, 120.0};
constexpr double kDepth = 0.08;  // m

geometry_msgs::TransformStamped transform(const std::string& parent, const std::string& child, double stamp,
                                          const Eigen::Isometry3d& parent_T_child) {
  geometry_msgs::TransformStamped message;
  message.header.frame_id = parent;
  message.header.stamp = ros::Time(stamp);
  message.child_frame_id = child;
  const Eigen::Quaterniond q(parent_T_child.linear());
  message.transform.rotation.w = q.w();
  message.transform.rotation.x = q.x();
  message.transform.rotation.y = q.y();
  message.transform.rotation.z = q.z();
  message.transform.translation.x = parent_T_child.translation().x();
  message.transform.translation.y = parent_T_child.translation().y();
  message.transform.translation.z = parent_T_child.translation().z();
  return message;
}

// The camera behind an arm that is turned against the room.
Eigen::Isometry3d armPose() {
  Eigen::Isometry3d base_T_camera = Eigen::Isometry3d::Identity();
  base_T_camera.linear() = Eigen::AngleAxisd(2.0, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  base_T_camera.translation() << 0.4, -0.2, 0.3;
  return base_T_camera;
}

// Jumps of about 60 px in the image.
Eigen::Isometry3d motionOf(int frame) {
  Eigen::Isometry3d start_T_now = Eigen::Isometry3d::Identity();
  const double side = frame % 2 == 0 ? 0.0 : 1.0;
  start_T_now.translation() << 0.015 * side, -0.007 * side, 0.003 * side;
  start_T_now.linear() = Eigen::AngleAxisd(0.15 * side, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return start_T_now;
}

double timeOf(int frame) {
  return 1000.0 + 0.04 * frame;
}

Eigen::Matrix3d truth(int frame) {
  return geometry::pixelsFromPlane(motionOf(frame).inverse(), Eigen::Vector3d::UnitZ(), kDepth, kCamera);
}

TEST(CameraMotionTest, IsFromTheFirstImageToTheSecondInTheCamerasOwnFrame) {
  tf2::BufferCore tf;
  for (const int frame : {0, 1}) {
    tf.setTransform(transform("base", "camera", timeOf(frame), armPose() * motionOf(frame)), "test");
  }
  std::string why;
  const auto motion = cameraMotion(tf, "base", "camera", ros::Time(timeOf(0)), ros::Time(timeOf(1)), why);
  ASSERT_TRUE(motion) << why;
  EXPECT_TRUE(motion->isApprox(motionOf(1).inverse(), 1e-9)) << motion->matrix();
  EXPECT_EQ(why, "");
}

TEST(CameraMotionTest, IsNotThereWhenTfDoesNotKnow) {
  tf2::BufferCore tf;
  std::string why;
  const auto ask = [&](const std::string& frame, double to) {
    why.clear();
    return cameraMotion(tf, "base", frame, ros::Time(timeOf(0)), ros::Time(to), why).has_value();
  };
  EXPECT_FALSE(ask("camera", timeOf(1)));
  EXPECT_NE(why.find("base"), std::string::npos) << why;
  for (const int frame : {0, 1}) tf.setTransform(transform("base", "camera", timeOf(frame), armPose()), "test");
  EXPECT_TRUE(ask("camera", timeOf(1)));
  EXPECT_FALSE(ask("camera", timeOf(2))) << "which is in tf's future";
  EXPECT_NE(why.find("stamps"), std::string::npos) << why;
  EXPECT_FALSE(ask("", timeOf(1)));
  EXPECT_FALSE(ask("/camera", timeOf(1)));
  EXPECT_FALSE(ask("no_such_frame", timeOf(1)));
  EXPECT_NE(why, "");
}

class SessionWithRobot : public testing::Test {
 protected:
  SessionWithRobot() {
    TrackerParameters parameters;
    parameters.roi = kRoi;
    parameters.robot_motion.enabled = true;
    parameters.robot_motion.fixed_frame = "base";
    parameters.robot_motion.depth = kDepth;
    // What is searched for afterwards is another matter.
    parameters.tracking.search.features = parameters.tracking.search.correlation = false;
    session_ = std::make_unique<TrackerSession>(parameters);
    sensor_msgs::CameraInfo info;
    info.K = {300.0, 0.0, 160.0, 0.0, 300.0, 120.0, 0.0, 0.0, 1.0};
    session_->setCameraInfo(info);
  }

  void followTf() {
    session_->setCameraMotion([this](const std::string& frame, const ros::Time& from, const ros::Time& to,
                                     std::string& why) { return cameraMotion(tf_, "base", frame, from, to, why); });
  }

  void moveArm(int frame) {
    tf_.setTransform(transform("base", "camera", timeOf(frame), armPose() * motionOf(frame)), "test");
  }

  Processed process(int frame) {
    std_msgs::Header header;
    header.stamp = ros::Time(timeOf(frame));
    header.frame_id = "camera";
    cv::Mat picture = test_support::view(scene_, truth(frame));
    cv::Mat noise(picture.size(), picture.type());  // a picture that repeats is a frozen one
    cv::RNG(static_cast<std::uint64_t>(frame) + 1).fill(noise, cv::RNG::UNIFORM, 0, 3);
    return session_->process(picture + noise, header);
  }

  static double error(const Processed& processed, int frame) {
    double worst = 0.0;
    for (const Eigen::Vector2d& corner : kRoi.corners()) {
      worst =
          std::max(worst, (geometry::apply(processed.result.g, corner) - geometry::apply(truth(frame), corner)).norm());
    }
    return worst;
  }

  const cv::Mat scene_ = test_support::texture(kSize);
  tf2::BufferCore tf_;
  std::unique_ptr<TrackerSession> session_;
};

TEST_F(SessionWithRobot, FollowsJumpsThatTfKnows) {
  followTf();
  for (int frame = 0; frame < 8; ++frame) {
    moveArm(frame);
    const Processed processed = process(frame);
    ASSERT_EQ(processed.result.state, State::kTracking) << frame << ": " << processed.result.reason;
    EXPECT_LT(error(processed, frame), 0.3) << frame;
    EXPECT_EQ(processed.motion_wanted, frame > 0);
    EXPECT_EQ(processed.result.motion_used, frame > 0);
    EXPECT_EQ(processed.motion_error, "");
  }
}

TEST_F(SessionWithRobot, LosesThemWithout) {
  int tracked = 0;
  for (int frame = 0; frame < 6; ++frame) {
    const Processed processed = process(frame);
    EXPECT_FALSE(processed.motion_wanted);
    tracked += frame % 2 == 1 && processed.result.state == State::kTracking ? 1 : 0;
  }
  EXPECT_EQ(tracked, 0);
}

TEST_F(SessionWithRobot, SaysWhyThereIsNoMotion) {
  followTf();
  moveArm(0);
  process(0);
  std_msgs::Header header;
  header.stamp = ros::Time(timeOf(1));
  header.frame_id = "camera";
  const Processed late = session_->process(test_support::view(scene_, truth(0)), header);
  EXPECT_EQ(late.result.state, State::kTracking) << late.result.reason;
  EXPECT_TRUE(late.motion_wanted);
  EXPECT_NE(late.motion_error.find("stamps"), std::string::npos) << late.motion_error;
  EXPECT_FALSE(late.result.motion_used);
}

TEST_F(SessionWithRobot, BearsMotionsThatCannotBe) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Eigen::Isometry3d through = Eigen::Isometry3d::Identity(), not_finite = through;
  through.translation().z() = -0.2;
  not_finite.translation().x() = nan;
  Eigen::Isometry3d bad;
  session_->setCameraMotion([&bad](const std::string&, const ros::Time&, const ros::Time&, std::string&) {
    return std::optional<Eigen::Isometry3d>(bad);
  });
  process(0);
  int at = 2;
  for (const Eigen::Isometry3d& each : {through, not_finite}) {
    bad = each;
    const Processed processed = process(at);
    EXPECT_EQ(processed.result.state, State::kTracking) << processed.result.reason;
    EXPECT_NE(processed.motion_error, "");
    EXPECT_FALSE(processed.result.motion_used);
    at += 2;
  }
}

}  // namespace
}  // namespace laparoscope_servo
