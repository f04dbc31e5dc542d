// The display in space of a real rviz, with an instrument of which the test says where it is.
#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <laparoscope_servo/TrackedFeatures.h>
#include <sensor_msgs/CameraInfo.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <Eigen/Geometry>
#include <QImage>
#include <cmath>
#include <limits>
#include <mutex>

#include "support/ros_tests.h"
#include "system/screen/display_text.h"
#include "system/screen/rviz_process.h"
#include "system/screen/virtual_display.h"

namespace laparoscope_servo {
namespace {

using test_support::RvizProcess;

const char* const kConfiguration = R"(Panels: []
Visualization Manager:
  Class: ""
  Global Options: {Fixed Frame: map, Frame Rate: 10, Background Color: 20; 20; 20}
  Displays:
    - {Class: laparoscope_servo/Space, Name: Space, Enabled: true, Namespace: "", Camera info: camera/camera_info}
  Tools:
    - Class: rviz/Interact
  Views:
    Current:
      Class: rviz/Orbit
      Name: Current View
      Distance: 0.15
      Focal Point: {X: 0, Y: 0, Z: 0.1}
      Pitch: -0.4
      Yaw: -1.2
      Near Clip Distance: 0.001
    Saved: ~
Window Geometry: {Width: 1000, Height: 800, X: 0, Y: 0}
)";

constexpr double kSigma = 0.003;  // m, of the shaft's place across its axis

// A shaft across the picture, 0.1 m before the camera, and its tip.
TrackedFeatures instrument() {
  const Eigen::Vector3d tip(0.02, 0.0, 0.1), axis = Eigen::Vector3d::UnitX();
  const Eigen::AngleAxisd turn(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis));
  TrackedFeature pose;
  pose.id = "1";
  pose.kind = TrackedFeature::POSE;
  pose.state = TrackedFeatures::TRACKING;
  pose.radius = 0.0025;
  const Eigen::Vector3d rotation = turn.angle() * turn.axis();
  pose.parameters = {tip.x(), tip.y(), tip.z(), rotation.x(), rotation.y(), rotation.z()};
  pose.covariance.assign(36, 0.0);
  for (const std::size_t k : {0, 1, 2}) pose.covariance[7 * k] = kSigma * kSigma;
  pose.covariance[21] = 1e6;  // its turn about the axis is open
  pose.outline = {160.0 - 200.0 * 0.4, 120.0, 160.0 + 200.0 * 0.2, 120.0};
  TrackedFeatures message;
  message.state = TrackedFeatures::TRACKING;
  message.features = {pose};
  return message;
}

class ScreenSpace : public testing::Test {
 protected:
  ScreenSpace() {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = "map";
    transform.child_frame_id = "camera";
    transform.transform.rotation.w = 1.0;
    tf_.sendTransform(transform);
    timer_ = node_.createWallTimer(ros::WallDuration(0.05), [this](const ros::WallTimerEvent&) { publish(); });
  }
  void publish() {
    sensor_msgs::CameraInfo info;
    info.header.frame_id = "camera";
    info.header.stamp = ros::Time::now();
    info.width = 320;
    info.height = 240;
    info.K = {200.0, 0.0, 160.0, 0.0, 200.0, 120.0, 0.0, 0.0, 1.0};
    infos_.publish(info);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (message_.features.empty()) return;
    message_.header = info.header;
    features_.publish(message_);
  }
  void say(const TrackedFeatures& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    message_ = message;
  }
  bool isRead(const std::string& word) {
    return RvizProcess::waitFor(
        [&] { return test_support::notRead(seen_ = test_support::textOnDisplay(), {word}).empty(); });
  }
  // Columns of the display in which the lines of the spread are drawn, and the most rows between them.
  std::pair<int, int> spreadOnDisplay() const {
    const test_support::TemporaryFolder folder;
    const std::string file = folder.file("display.png");
    if (std::system(("import -silent -window root " + file).c_str()) != 0) return {0, 0};
    const QImage shown(QString::fromStdString(file));
    int columns = 0, tallest = 0;
    for (int x = 0; x < shown.width(); ++x) {
      int first = -1, last = -1;
      for (int y = 0; y < shown.height(); ++y) {
        const QColor c = shown.pixelColor(x, y);
        if (c.green() < 150 || c.green() - c.red() < 70 || c.green() - c.blue() < 70) continue;
        if (first < 0) first = y;
        last = y;
      }
      columns += first >= 0 ? 1 : 0;
      tallest = std::max(tallest, last - first);
    }
    return {columns, tallest};
  }

  test_support::VirtualDisplay display_{"1000x800"};
  ros::NodeHandle node_;
  ros::Publisher infos_ = node_.advertise<sensor_msgs::CameraInfo>("camera/camera_info", 1);
  ros::Publisher features_ = node_.advertise<TrackedFeatures>("instrument/features", 1);
  tf2_ros::StaticTransformBroadcaster tf_;
  std::mutex mutex_;
  TrackedFeatures message_ = instrument();
  std::string seen_;
  ros::WallTimer timer_;
  RvizProcess rviz_{kConfiguration};
};

TEST_F(ScreenSpace, AnInstrumentIsACylinderWithItsSpread) {
  ASSERT_TRUE(rviz_.comesUp([this] { return features_.getNumSubscribers() > 0 && infos_.getNumSubscribers() > 0; }))
      << rviz_.log();
  EXPECT_TRUE(isRead("100 mm from the camera")) << seen_;
  const std::pair<int, int> known = spreadOnDisplay();
  EXPECT_GT(known.first, 100) << "columns of the display";

  // Twice as uncertain: between radius + 6 mm and radius + 12 mm.
  TrackedFeatures message = instrument();
  for (const std::size_t k : {0, 1, 2}) message.features[0].covariance[7 * k] *= 4.0;
  say(message);
  std::pair<int, int> vague;
  EXPECT_TRUE(RvizProcess::waitFor([&] { return (vague = spreadOnDisplay()).second > 1.4 * known.second; }))
      << vague.second << " rows of the display, before " << known.second;

  message.features[0].covariance[0] = 1e6;  // along the axis
  say(message);
  EXPECT_TRUE(isRead("its end not known")) << seen_;

  message = instrument();
  message.features[0].state = TrackedFeatures::SEARCHING;
  for (std::size_t k = 0; k < 6; ++k) message.features[0].covariance[7 * k] = std::numeric_limits<double>::infinity();
  say(message);
  EXPECT_TRUE(isRead("SEARCHING")) << seen_;
  EXPECT_LT(spreadOnDisplay().first, 100) << "the frame of the label";

  say({});
  EXPECT_TRUE(isRead("s ago")) << seen_;
  say(instrument());
  EXPECT_TRUE(isRead("100 mm from the camera")) << seen_;
  EXPECT_TRUE(rviz_.ends()) << rviz_.log();
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "screen_space_test");
}
