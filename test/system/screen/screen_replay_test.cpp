// replay.launch with the screen's window, to the end of the recording, or to where it breaks off: what a user sees,
// read by OCR.
#include <cv_bridge/cv_bridge.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>

#include <QGuiApplication>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "support/synthetic_sequence.h"
#include "support/temporary_folder.h"
#include "system/aesop/child_process.h"
#include "system/screen/display_text.h"
#include "system/screen/virtual_display.h"

namespace laparoscope_servo {
namespace {

constexpr int kImages = 40;

class ScreenReplay : public testing::Test {
 protected:
  ScreenReplay() {
    std::filesystem::create_directory(folder_.file("images"));
    const cv::Mat scene = test_support::texture({480, 400});
    for (int k = 0; k < kImages; ++k) {
      cv::imwrite(folder_.file(cv::format("images/%03d.png", k)), scene(cv::Rect(40 + k, 40 + k / 2, 320, 240)));
    }
  }

  test_support::VirtualDisplay display_;
  test_support::TemporaryFolder folder_;
};

TEST_F(ScreenReplay, SaysThatTheRecordingHasEnded) {
  const std::string log = folder_.file("log");
  test::ChildProcess launch(
      "/bin/sh",
      {"-c", "exec roslaunch laparoscope_servo replay.launch screen:=window roi:=100,60,100,100 video:=" +
                 folder_.file("images")},
      log);
  const std::vector<std::string> words{"ENDED", "last picture"};
  const std::string text = test_support::readUntil(words);
  EXPECT_EQ(test_support::notRead(text, words), "") << text;
  launch.kill(SIGINT);
  EXPECT_EQ(launch.exitStatus(60.0), 0);
}

// As a copy that was not finished leaves it.
TEST_F(ScreenReplay, SaysThatABagWasCutOffAndWhatToDo) {
  const std::string file = folder_.file("cut.bag");
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    for (int k = 0; k < kImages; ++k) {
      std_msgs::Header header;
      header.stamp = ros::Time(100.0 + 0.04 * k);
      const cv::Mat image = cv::imread(folder_.file(cv::format("images/%03d.png", k)));
      bag.write("/camera/image_raw", header.stamp, *cv_bridge::CvImage(header, "bgr8", image).toImageMsg());
    }
  }
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  test::ChildProcess launch("/bin/sh",
                            {"-c", "exec roslaunch laparoscope_servo replay.launch screen:=window bag:=" + file},
                            folder_.file("log"));
  const std::vector<std::string> words{"UNREADABLE", "breaks off", "reindex"};
  const std::string text = test_support::readUntil(words);
  EXPECT_EQ(test_support::notRead(text, words), "") << text;
  EXPECT_TRUE(launch.isRunning());
  launch.kill(SIGINT);
  EXPECT_NE(launch.exitStatus(60.0), -1) << "it ends";
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
