// A case of the simulated cart as record.launch writes it, and what is shown of it later: replay.launch, track_bag and
// session_report have the results of then beside those that are computed now.
#include <gtest/gtest.h>
#include <laparoscope_servo/SelectRoi.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CompressedImage.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <map>
#include <memory>
#include <set>

#include "laparoscope_servo/Homography.h"
#include "laparoscope_servo/sim/emulator_control_client.h"
#include "node/sim/node_bench.h"
#include "ros/playback/corners_apart.h"
#include "system/screen/display_text.h"
#include "system/screen/virtual_display.h"

namespace laparoscope_servo::test {
namespace {

constexpr double kPatience = 90.0;  // s: roslaunch starts for many on a busy machine
constexpr std::size_t kTracked = 80;
// px, between what was computed of the images and of their JPEGs. The noise of the simulated camera alone moves a
// corner by some 0.05.
constexpr double kFarthest = 1.0;
const std::string kRegion = "230,150,180,180";

class ScreenRecording : public testing::Test {
 protected:
  std::unique_ptr<ChildProcess> launch(const std::string& arguments, const std::string& log) const {
    return std::make_unique<ChildProcess>(
        "/bin/sh", std::vector<std::string>{"-c", "exec roslaunch laparoscope_servo " + arguments}, folder_.file(log));
  }
  static void end(ChildProcess& child) {
    child.kill(SIGINT);
    EXPECT_TRUE(spinUntil([&] { return !child.isRunning(); }, kPatience));
  }

  // The scope is moved by hand and back; the region stays in the picture.
  void record() {
    Recorder<Homography> results(node_, "/tracker/homography");
    const auto demo = launch(
        "demo.launch screen:=none port:=" + folder_.file("arm") + " control:=" + folder_.file("control"), "demo");
    const auto recorder = launch("record.launch folder:=" + folder_.file("case"), "recorder");
    ASSERT_TRUE(spinUntil([&] { return results.all.size() > 10 && records(); }, kPatience))
        << contents(folder_.file("demo")) << contents(folder_.file("recorder"));
    const std::size_t unselected = results.all.size();
    ASSERT_TRUE(spinUntil([&] { return results.all.size() > unselected + 10; }, kPatience));
    SelectRoi call;
    ASSERT_EQ(std::sscanf(kRegion.c_str(), "%u,%u,%u,%u", &call.request.roi.x_offset, &call.request.roi.y_offset,
                          &call.request.roi.width, &call.request.roi.height),
              4);
    ASSERT_TRUE(ros::service::call("/tracker/select_roi", call) && call.response.success) << call.response.message;
    sim::EmulatorControlClient arm(folder_.file("control"), 10.0);
    arm.hand({0.05, 0.03, 0.0, 0.005}, 1.5);
    const std::size_t before = results.all.size();
    ASSERT_TRUE(spinUntil([&] { return results.all.size() > before + kTracked / 2; }, kPatience));
    arm.hand({-0.05, -0.03, 0.0, -0.005}, 1.5);
    ASSERT_TRUE(spinUntil([&] { return results.all.size() > before + kTracked + 20; }, kPatience));
    end(*recorder);
    end(*demo);
    ASSERT_TRUE(findReference());
  }
  bool records() const {
    std::error_code none;
    const std::filesystem::directory_iterator files(folder_.file("case"), none);
    return files != std::filesystem::directory_iterator();
  }
  // Where the region was selected, from the bag alone.
  bool findReference() {
    for (const auto& entry : std::filesystem::directory_iterator(folder_.file("case"))) bag_ = entry.path();
    rosbag::Bag bag(bag_, rosbag::bagmode::Read);
    ros::Time reference;
    std::set<ros::Time> tracked;
    for (const rosbag::MessageInstance& message : rosbag::View(bag, rosbag::TopicQuery("/tracker/homography"))) {
      const HomographyConstPtr result = message.instantiate<Homography>();
      if (result->state == Homography::TRACKING && reference.isZero()) reference = result->reference_stamp;
      if (result->state == Homography::TRACKING) tracked.insert(result->header.stamp);
    }
    rosbag::View images(bag, rosbag::TopicQuery("/camera/image_raw/compressed"));
    for (const rosbag::MessageInstance& message : images) {
      const ros::Time stamp = message.instantiate<sensor_msgs::CompressedImage>()->header.stamp;
      if (stamp == reference) start_ = std::to_string((message.getTime() - images.getBeginTime()).toSec() - 0.01);
      tracked_ += tracked.count(stamp);
    }
    return !start_.empty();
  }

  test_support::VirtualDisplay display_;
  test_support::TemporaryFolder folder_;
  ros::NodeHandle node_;
  std::string bag_;
  std::string start_;        // s
  std::size_t tracked_ = 0;  // images that were recorded, and tracked: on a busy machine the recorder drops some
};

TEST_F(ScreenRecording, StandsBesideWhatIsComputedNow) {
  ASSERT_NO_FATAL_FAILURE(record());
  ASSERT_GT(tracked_, kTracked);

  Recorder<Homography> recorded(node_, "/recorded/tracker/homography");
  Recorder<Homography> computed(node_, "/tracker/homography");
  // With this test, so that it receives all.
  const auto replay = launch("replay.launch screen:=window hold:=false speed:=100 subscribers:=2 start:=" + start_ +
                                 " roi:=" + kRegion + " bag:=" + bag_,
                             "replay");
  ASSERT_TRUE(spinUntil([&] { return recorded.connected() && computed.connected(); }, kPatience));
  const Recorder<sensor_msgs::Image> images(node_, "/camera/image_raw");
  ASSERT_TRUE(spinUntil([&] { return !replay->isRunning() || computed.all.size() >= tracked_; }, kPatience))
      << contents(folder_.file("replay"));
  std::map<ros::Time, HomographyConstPtr> then;
  for (const auto& result : recorded.all) then[result->header.stamp] = result;
  std::size_t both = 0;
  double farthest = 0.0;
  for (const auto& result : computed.all) {
    const auto found = then.find(result->header.stamp);
    if (found == then.end() || found->second->state != Homography::TRACKING) continue;
    ASSERT_EQ(result->state, Homography::TRACKING) << result->header.stamp;
    ++both;
    farthest = std::max(farthest, cornersApart(result->corners, found->second->corners));
  }
  EXPECT_EQ(both, tracked_);
  EXPECT_LT(farthest, kFarthest);
  EXPECT_GT(farthest, 0.0) << "they are computed of a JPEG, with the rounding of it";
  const std::string text = test_support::readUntil({"Recorded:", "px away"}, kPatience);
  EXPECT_EQ(test_support::notRead(text, {"Recorded:", "px away"}), "") << text;
  end(*replay);

  const std::string again = folder_.file("again.bag"), page = folder_.file("report.html");
  const auto tracked = test_support::outputOf("rosrun laparoscope_servo track_bag " + bag_ + " --start " + start_ +
                                              " --roi " + kRegion + " --output " + again);
  EXPECT_EQ(tracked.status, 0) << tracked.text;
  EXPECT_NE(tracked.text.find("recorded results: in "), std::string::npos) << tracked.text;
  const auto report =
      test_support::outputOf("rosrun laparoscope_servo session_report " + bag_ + " " + page + " --recomputed " + again);
  EXPECT_EQ(report.status, 0) << report.text;
  const std::string html = contents(page);
  EXPECT_NE(html.find(": " + std::to_string(tracked_) + " were tracked by both, 0 when"), std::string::npos)
      << html.substr(html.find("Recorded and"), 400);
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "screen_recording_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
