// The node `recorder` as a process: what it writes, also when it is killed or the disk is full.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <laparoscope_servo/ControllerState.h>
#include <laparoscope_servo/ScopeVelocity.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CompressedImage.h>
#include <std_msgs/String.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <memory>

#include "node/sim/node_bench.h"
#include "ros/tracker/result_messages.h"

namespace laparoscope_servo::test {
namespace {

class RecorderNode : public testing::Test {
 protected:
  RecorderNode() {
    ros::param::set("/recorder/folder", folder_.file("case"));
    ros::param::set("/recorder/topics", std::vector<std::string>{"controller/state", "servo_command"});
    ros::param::set("/recorder/min_free", 1.0);
    ros::param::set("/recorder/waiting_images", 1000);
    ros::param::set("/marker_of_this_test", "is here");
  }
  ~RecorderNode() override { ros::param::del("/recorder"); }

  void start() {
    process_ = std::make_unique<ChildProcess>(
        RECORDER, std::vector<std::string>{"__name:=recorder", "image:=camera/image_raw"}, log());
    ASSERT_TRUE(spinUntil([this] {
      return images_.getNumSubscribers() > 0 && states_.getNumSubscribers() > 0 && commands_.getNumSubscribers() > 0;
    })) << contents(log());
  }
  // Numbered by insertion and by stamp.
  void publish(int from, int to, int width = 64) {
    for (int k = from; k < to; ++k) {
      ScopeVelocity command;
      command.insertion = k;
      commands_.publish(command);
      std_msgs::Header header;
      header.stamp = ros::Time(1000.0 + k);
      cv::Mat pixels(width * 3 / 4, width, CV_8UC3);
      if (width > 64) cv::randu(pixels, 0, 255);
      images_.publish(imageMessage(header, pixels));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));  // a camera's rate; nothing waits for it
    }
  }
  void publishState() {
    ControllerState state;
    state.state = "IDLE";
    states_.publish(state);
  }
  std::vector<std::string> files(const std::string& ending) const {
    std::vector<std::string> names;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.file("case"), none)) {
      const std::string name = entry.path();
      if (name.size() > ending.size() && name.substr(name.size() - ending.size()) == ending) names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  static std::map<std::string, int> countsOf(const std::string& file) {
    rosbag::Bag bag(file, rosbag::bagmode::Read);
    rosbag::View view(bag);
    std::map<std::string, int> counts;
    for (const rosbag::MessageInstance& message : view) ++counts[message.getTopic()];
    return counts;
  }
  // A value of its diagnostics.
  std::string told(const std::string& key) const {
    std::string value;
    for (const auto& array : diagnostics_.all) {
      for (const auto& status : array->status) {
        if (status.name.find("recording") == std::string::npos) continue;
        for (const auto& pair : status.values) {
          if (pair.key == key) value = pair.value;
        }
      }
    }
    return value;
  }
  bool toldAtLeast(const std::string& key, int number) const {
    const std::string value = told(key);
    return !value.empty() && std::stoi(value) >= number;
  }
  void stop() {
    process_->kill(SIGINT);
    ASSERT_EQ(process_->exitStatus(30.0), 0) << contents(log());
  }
  std::string log() const { return folder_.file("recorder.log"); }

  test_support::TemporaryFolder folder_;
  ros::NodeHandle node_;
  ros::Publisher images_ = node_.advertise<sensor_msgs::Image>("camera/image_raw", 100);
  ros::Publisher states_ = node_.advertise<ControllerState>("controller/state", 10, true);
  ros::Publisher commands_ = node_.advertise<ScopeVelocity>("servo_command", 100);
  Recorder<diagnostic_msgs::DiagnosticArray> diagnostics_{node_, "/diagnostics"};
  std::unique_ptr<ChildProcess> process_;
};

TEST_F(RecorderNode, WritesImagesAndMessagesAndWhatTheSessionWas) {
  publishState();
  ASSERT_NO_FATAL_FAILURE(start());
  publish(0, 20);
  ASSERT_TRUE(spinUntil([this] { return toldAtLeast("messages written", 42); })) << contents(log());
  ASSERT_NO_FATAL_FAILURE(stop());
  ASSERT_EQ(files(".bag").size(), 1u);
  EXPECT_TRUE(files(".active").empty());
  rosbag::Bag bag(files(".bag")[0], rosbag::bagmode::Read);
  rosbag::View view(bag);
  std::vector<int> images;
  int commands = 0;
  std::string session;
  for (const rosbag::MessageInstance& message : view) {
    if (const auto image = message.instantiate<sensor_msgs::CompressedImage>()) {
      EXPECT_EQ(message.getTopic(), "/camera/image_raw/compressed");
      EXPECT_EQ(image->format, "bgr8; jpeg compressed bgr8");
      images.push_back(static_cast<int>(image->header.stamp.toSec() - 1000.0));
    }
    if (const auto command = message.instantiate<ScopeVelocity>()) {
      EXPECT_EQ(command->insertion, commands++);
    }
    if (const auto text = message.instantiate<std_msgs::String>()) session = text->data;
  }
  EXPECT_EQ(images.size(), 20u);
  EXPECT_TRUE(std::is_sorted(images.begin(), images.end()));
  EXPECT_EQ(commands, 20);
  EXPECT_NE(session.find("marker_of_this_test"), std::string::npos) << session;
  EXPECT_EQ(told("images dropped: no encoder was free"), "0");
}

TEST_F(RecorderNode, SplitsSoThatEachFileStandsForItself) {
  ros::param::set("/recorder/split_size", 1.0);
  publishState();
  ASSERT_NO_FATAL_FAILURE(start());
  publish(0, 30, 640);  // noise: some 0.4 MB each
  ASSERT_TRUE(spinUntil([this] { return toldAtLeast("files", 3); })) << contents(log());
  ASSERT_NO_FATAL_FAILURE(stop());
  const auto bags = files(".bag");
  ASSERT_GE(bags.size(), 3u);
  for (const std::string& file : bags) {
    const auto counts = countsOf(file);
    EXPECT_EQ(counts.count("/session"), 1u) << file;
    EXPECT_EQ(counts.count("/controller/state"), 1u) << "what is latched begins each file: " << file;
  }
}

TEST_F(RecorderNode, OneCutOffIsReadableUpToThere) {
  ASSERT_NO_FATAL_FAILURE(start());
  publish(0, 30, 640);
  ASSERT_TRUE(spinUntil([this] { return toldAtLeast("messages written", 61); })) << contents(log());
  process_->kill(SIGKILL);
  process_->exitStatus(10.0);
  ASSERT_EQ(files(".bag.active").size(), 1u);
  const std::string file = files(".bag.active")[0];
  ASSERT_EQ(std::system(("rosbag reindex -q '" + file + "'").c_str()), 0);
  const auto counts = countsOf(file);
  EXPECT_GE(counts.at("/camera/image_raw/compressed"), 20) << "all but what was in the last chunk";
}

TEST_F(RecorderNode, WithTooLittleRoomItWritesNothingAndSaysSo) {
  ros::param::set("/recorder/min_free", 1e6);
  ASSERT_NO_FATAL_FAILURE(start());
  publish(0, 5);
  ASSERT_TRUE(spinUntil([this] { return toldAtLeast("messages not written", 10); })) << contents(log());
  EXPECT_NE(contents(log()).find("are needed to record"), std::string::npos) << contents(log());
  ASSERT_NO_FATAL_FAILURE(stop());
  EXPECT_TRUE(files(".bag").empty());
}

TEST_F(RecorderNode, SaysThatItsFolderCannotBeMade) {
  ros::param::set("/recorder/folder", "/proc/none");
  ChildProcess process(RECORDER, {"__name:=recorder"}, log());
  EXPECT_EQ(process.exitStatus(20.0), 1);
  EXPECT_NE(contents(log()).find("/proc/none"), std::string::npos) << contents(log());
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "recorder_test");
  ros::NodeHandle keeps_ros_up;
  return RUN_ALL_TESTS();
}
