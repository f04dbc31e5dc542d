// The nodelet Model: selects by a pose that is off, publishes pose and tf, refuses what cannot be, and goes on.
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <gtest/gtest.h>
#include <ros/package.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <tf2_msgs/TFMessage.h>
#include <tf2_ros/transform_broadcaster.h>

#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <utility>

#include "feature_bench.h"
#include "support/synthetic_model.h"

namespace laparoscope_servo {
namespace {

using test_support::DiagnosticsListener;
using test_support::FeatureBench;
using test_support::Inbox;
using test_support::waitFor;

const char* const kKind = "model";
const char* const kWithoutTf = "quiet";

const model::CadModel& box() {
  static const auto box =
      model::readCadModel(ros::package::getPath("laparoscope_servo") + "/test/node/features/box.cao");
  return *box;
}

// Of the k-th image.
Eigen::Isometry3d truth(int k) {
  return test::viewOf(box(), 0.25, 0.6 + 0.01 * k);
}

cv::Mat drawn(int k, unsigned number) {
  static const test::ModelRenderer renderer(box(), test::ModelScene());
  return renderer.draw(truth(k), number);
}

class ModelNodelet : public testing::Test {
 protected:
  struct Bench : FeatureBench {
    Bench() : FeatureBench({kKind, kWithoutTf, "edges"}, [](unsigned number) { return drawn(0, number); }) {}

    ros::Publisher infos = node().advertise<sensor_msgs::CameraInfo>("camera_info", 1, true);
    Inbox<geometry_msgs::PoseWithCovarianceStamped> poses{node(), "model/pose"};
    Inbox<geometry_msgs::PoseWithCovarianceStamped> quiet_poses{node(), "quiet/pose"};
    std::mutex mutex;
    std::map<std::string, geometry_msgs::TransformStamped> transforms;  // the newest of each child
    ros::Subscriber tf_subscriber =
        node().subscribe<tf2_msgs::TFMessage>("/tf", 100, [this](const tf2_msgs::TFMessageConstPtr& tf) {
          const std::lock_guard<std::mutex> lock(mutex);
          for (const auto& each : tf->transforms) transforms[each.child_frame_id] = each;
        });
  };
  static Bench& bench() {
    static Bench bench;
    return bench;
  }

  void SetUp() override {
    ASSERT_TRUE(bench().ready() && waitFor([] {
                  return bench().infos.getNumSubscribers() >= 1 && bench().poses.connected() &&
                         bench().quiet_poses.connected() && bench().tf_subscriber.getNumPublishers() > 0;
                }));
    // Whatever the test before did to time and size.
    ASSERT_TRUE(bench().settle(kKind));
    for (const char* const each : {kKind, kWithoutTf, "edges"}) ASSERT_TRUE(bench().reset(each));
  }

  static TrackedFeaturesConstPtr track(int k) { return bench().track(kKind, drawn(k, bench().nextNumber())); }

  // About the truth of image 0, turned about the object's centre (rotation vector, rad, axes of the camera) and
  // shifted (m).
  static std::string selection(const Eigen::Vector3d& turn = {0.05, -0.06, 0.04}, double shift = 0.004) {
    Eigen::Isometry3d pose = truth(0);
    pose.linear() = geometry::so3Exp(turn) * pose.linear();
    pose.translation() = truth(0) * box().centre - pose.linear() * box().centre;
    pose.translation().x() += shift;
    const Eigen::Vector3d rotation = geometry::so3Log(pose.linear());
    std::ostringstream text;
    text << "[{id: box, pose: [" << pose.translation().x() << ", " << pose.translation().y() << ", "
         << pose.translation().z() << ", " << rotation.x() << ", " << rotation.y() << ", " << rotation.z() << "]}]";
    return text.str();
  }

  // After camera_info has come.
  static void select(const char* kind, const std::string& text = selection()) {
    sensor_msgs::CameraInfo info;
    info.width = 320;
    info.height = 240;
    const geometry::PinholeCamera camera = test::ModelScene().camera;
    info.K = {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
    bench().infos.publish(info);
    SelectFeatures::Response answer;
    ASSERT_TRUE(waitFor([&] {
      answer = bench().select(kind, text);
      return answer.success != 0 || answer.message.find("camera_info") == std::string::npos;
    }));
    ASSERT_TRUE(answer.success) << answer.message;
  }
};

// The first test: nobody has said yet which camera it is.
TEST_F(ModelNodelet, RefusesToSelectWithoutTheCamera) {
  const SelectFeatures::Response answer = bench().select(kKind, selection());
  EXPECT_FALSE(answer.success);
  EXPECT_NE(answer.message.find("camera_info"), std::string::npos) << answer.message;
}

TEST_F(ModelNodelet, FollowsAnObjectAndSaysWhereItIs) {
  select(kKind);
  TrackedFeaturesConstPtr told;
  for (int k = 1; k < 6; ++k) {
    told = track(k);
    ASSERT_TRUE(told) << k;
    ASSERT_EQ(told->state, TrackedFeatures::TRACKING) << k << ": " << told->reason;
  }
  ASSERT_EQ(told->features.size(), 1u);
  EXPECT_EQ(told->features[0].id, "box");
  EXPECT_EQ(told->features[0].kind, TrackedFeature::POSE);
  const auto pose = bench().poses.waitFor(told->header.stamp);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->header.frame_id, "optical_of_the_test");
  const geometry_msgs::Point& at = pose->pose.pose.position;
  EXPECT_LT((Eigen::Vector3d(at.x, at.y, at.z) - truth(5).translation()).norm(), 2e-3);
  const geometry_msgs::Quaternion& q = pose->pose.pose.orientation;
  EXPECT_LT(Eigen::Quaterniond(q.w, q.x, q.y, q.z).angularDistance(Eigen::Quaterniond(truth(5).linear())), 0.01);
  for (std::size_t k = 0; k < 36; k += 7) {
    EXPECT_GT(pose->pose.covariance[k], 0.0) << k;
    EXPECT_LT(pose->pose.covariance[k], 1e-3) << k;
  }
  const auto transformOf = [&] {
    const std::lock_guard<std::mutex> lock(bench().mutex);
    return bench().transforms["scope/model/box"];
  };
  ASSERT_TRUE(waitFor([&] { return transformOf().header.stamp == told->header.stamp; }));
  EXPECT_EQ(transformOf().header.frame_id, "optical_of_the_test");
  EXPECT_EQ(transformOf().transform.translation.z, at.z);
}

TEST_F(ModelNodelet, AStartThatIsFarOffEndsAtTheTruth) {
  select(kKind, selection({0.4, -0.35, 0.3}, 0.01));
  const TrackedFeaturesConstPtr told = track(0);
  ASSERT_TRUE(told);
  ASSERT_EQ(told->state, TrackedFeatures::TRACKING) << told->reason;
  const auto pose = bench().poses.waitFor(told->header.stamp);
  ASSERT_TRUE(pose);
  const geometry_msgs::Quaternion& q = pose->pose.pose.orientation;
  EXPECT_LT(Eigen::Quaterniond(q.w, q.x, q.y, q.z).angularDistance(Eigen::Quaterniond(truth(0).linear())), 0.01);
}

TEST_F(ModelNodelet, WithoutBeingAskedItSaysNothingOnTf) {
  select(kWithoutTf);
  const TrackedFeaturesConstPtr told = bench().trackUntil(kWithoutTf, TrackedFeatures::TRACKING);
  ASSERT_TRUE(told);
  ASSERT_TRUE(bench().quiet_poses.waitFor(told->header.stamp));
  const std::lock_guard<std::mutex> lock(bench().mutex);
  EXPECT_EQ(bench().transforms.count("scope/quiet/box"), 0u);
}

// The object rests, and the camera turns about its axis to and fro, from one image to the next by more than the tracker
// follows by itself (see ModelFeatureTrackerTest). tf and images come over two connections: where tf is late, the turn
// is made up for with a later image.
TEST_F(ModelNodelet, FollowsTurnsOfTheCameraThatTfKnows) {
  const DiagnosticsListener diagnostics(bench().node(), "scope/quiet");
  tf2_ros::TransformBroadcaster broadcaster;
  select(kWithoutTf);
  const auto see = [&broadcaster](bool is_turned) {
    const Eigen::Isometry3d base_T_camera(Eigen::AngleAxisd(is_turned ? 0.4 : 0.0, Eigen::Vector3d::UnitZ()));
    const Eigen::Quaterniond turn(base_T_camera.linear());
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = FeatureBench::nextStamp();
    transform.header.frame_id = "base_of_the_test";
    transform.child_frame_id = "optical_of_the_test";
    transform.transform.rotation.z = turn.z();
    transform.transform.rotation.w = turn.w();
    broadcaster.sendTransform(transform);
    const test::ModelRenderer renderer(box(), test::ModelScene());
    const cv::Mat image = renderer.draw(base_T_camera.inverse() * truth(0), bench().nextNumber());
    return bench().track(kWithoutTf, image, transform.header.stamp);
  };
  const auto tracks = [&see](bool is_turned) {
    const TrackedFeaturesConstPtr told = see(is_turned);
    return told && told->state == TrackedFeatures::TRACKING;
  };
  const auto tfIsThere = [&] { return tracks(false) && diagnostics.value("robot_motion") == "from tf"; };
  ASSERT_TRUE(waitFor(tfIsThere)) << diagnostics.last();
  for (const bool is_turned : {true, false, true, false})
    EXPECT_TRUE(waitFor([&] { return tracks(is_turned); })) << diagnostics.last();
}

TEST_F(ModelNodelet, WhatIsNotSeenHasNoPose) {
  select(kKind);
  const TrackedFeaturesConstPtr told = bench().track(kKind, cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)));
  ASSERT_TRUE(told);
  EXPECT_EQ(told->state, TrackedFeatures::SEARCHING);
  // What was published before the pose of a later image has come by then.
  const TrackedFeaturesConstPtr later = bench().trackUntil(kKind, TrackedFeatures::TRACKING);
  ASSERT_TRUE(later && bench().poses.waitFor(later->header.stamp));
  EXPECT_FALSE(bench().poses.at(told->header.stamp));
}

TEST_F(ModelNodelet, RefusesWhatCannotBeAndGoesOn) {
  select(kKind);
  const std::pair<const char*, const char*> wrong[] = {
      {"[{id: box, line: [[1, 2], [100, 200]]}]", "expected pose of this tracker"},
      {"[{id: box, pose: [0, 0, 0.25]}]", "six numbers"},
      {"[{id: box, pose: [0, 0, -0.25, 0, 0, 0]}]", "in front of the camera"},
      {"[{id: box, pose: [0.2, 0.2, 0.25, 0, 0, 0]}]", "box: no start"},
      {"[{id: box, pose: [0, 0, .inf, 0, 0, 0]}]", "finite"}};
  for (const auto& [text, part] : wrong) {
    const SelectFeatures::Response answer = bench().select(kKind, text);
    EXPECT_FALSE(answer.success) << text;
    EXPECT_NE(answer.message.find(part), std::string::npos) << answer.message;
  }
  const TrackedFeaturesConstPtr told = track(0);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->state, TrackedFeatures::TRACKING) << told->reason;
}

TEST_F(ModelNodelet, AnotherSizeOfImagesEndsIt) {
  select(kKind);
  TrackedFeaturesConstPtr told;
  ASSERT_TRUE(waitFor([&] {
    cv::Mat larger;
    cv::resize(bench().picture(), larger, cv::Size(), 1.5, 1.5);
    told = bench().track(kKind, larger, FeatureBench::nextStamp(), 0.5);
    EXPECT_TRUE(!told || told->state != TrackedFeatures::TRACKING);
    return told && told->state == TrackedFeatures::IDLE;
  })) << "another size is believed after some images";
  EXPECT_NE(told->reason.find("another size or type"), std::string::npos) << told->reason;
}

TEST_F(ModelNodelet, TimeThatJumpsBackEndsIt) {
  select(kKind);
  ros::Time stamp(100);
  TrackedFeaturesConstPtr told;
  ASSERT_TRUE(waitFor([&] {
    stamp += ros::Duration(0.04);
    return (told = bench().track(kKind, bench().picture(), stamp, 0.5)) != nullptr;
  })) << "an earlier time is believed after some images";
  EXPECT_EQ(told->state, TrackedFeatures::IDLE);
  EXPECT_EQ(told->reason, "time jumped back");
}

// The line is the box's own lower edge.
TEST_F(ModelNodelet, AnotherKindBesideItInOneManagerFollowsItsOwn) {
  select(kKind);
  const Eigen::Matrix3d camera = test::ModelScene().camera.matrix();
  const Eigen::Vector2d begin = (camera * (truth(0) * box().points[0])).hnormalized();
  const Eigen::Vector2d end = (camera * (truth(0) * box().points[1])).hnormalized();
  const Eigen::Vector2d a = begin + 0.15 * (end - begin), b = end + 0.15 * (begin - end);
  std::ostringstream line;
  line << "[{id: rim, line: [[" << a.x() << ", " << a.y() << "], [" << b.x() << ", " << b.y() << "]]}]";
  const SelectFeatures::Response answer = bench().select("edges", line.str());
  ASSERT_TRUE(answer.success) << answer.message;
  const TrackedFeaturesConstPtr edges = bench().trackUntil("edges", TrackedFeatures::TRACKING);
  ASSERT_TRUE(edges);
  EXPECT_EQ(edges->features.at(0).kind, TrackedFeature::LINE);
  const TrackedFeaturesConstPtr told = track(0);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->state, TrackedFeatures::TRACKING) << told->reason;
}

TEST_F(ModelNodelet, DoesNotStartWithAFileThatIsNoModel) {
  const std::pair<const char*, const char*> wrong[] = {{"wrong_index", "wrong_index.cao, line 9"},
                                                       {"zero_radius", "zero_radius.cao, line 9"},
                                                       {"not_finite", "not_finite.cao, line 4"},
                                                       {"missing", "/nowhere/object.cao"},
                                                       {"without", "tracking/file"}};
  for (const auto& [space, part] : wrong) {
    DiagnosticsListener diagnostics(bench().node(), std::string(space) + "/model");
    EXPECT_TRUE(diagnostics.waitForMessage(diagnostic_msgs::DiagnosticStatus::ERROR, part)) << diagnostics.last();
  }
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "model_nodelet_test");
}
