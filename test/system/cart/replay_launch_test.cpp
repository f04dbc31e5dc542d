// replay.launch as a user runs it, once and again on the same master.
#include <cv_bridge/cv_bridge.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Image.h>

#include <csignal>
#include <fstream>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "laparoscope_servo/Homography.h"
#include "node/sim/node_bench.h"
#include "ros/playback/corners_apart.h"

namespace laparoscope_servo::test {
namespace {

constexpr int kImages = 5;
constexpr double kLongest = 40.0;  // s: roslaunch takes a few to start and to end, many on a busy machine

class ReplayLaunch : public testing::Test {
 protected:
  static std::vector<cv::Mat> pictures() {
    cv::Mat picture(240, 320, CV_8UC3);
    cv::RNG(3).fill(picture, cv::RNG::UNIFORM, 0, 255);
    cv::GaussianBlur(picture, picture, {}, 3.0);
    cv::normalize(picture, picture, 0, 255, cv::NORM_MINMAX);
    std::vector<cv::Mat> pictures;
    cv::RNG random(4);
    for (int k = 0; k < kImages; ++k) {
      cv::Mat noise(picture.size(), CV_8UC3);  // a picture that repeats is a frozen one
      random.fill(noise, cv::RNG::UNIFORM, 0, 4);
      pictures.emplace_back(picture + noise);
    }
    return pictures;
  }
  std::string folder() {
    std::filesystem::create_directory(folder_.file("images"));
    int k = 0;
    for (const cv::Mat& picture : pictures())
      cv::imwrite(folder_.file("images/" + std::to_string(k++) + ".png"), picture);
    return folder_.file("images");
  }
  void writeCase() {
    rosbag::Bag bag(folder_.file("case.bag"), rosbag::bagmode::Write);
    ros::Time time(100.0);
    for (const cv::Mat& picture : pictures()) {
      std_msgs::Header header;
      header.stamp = time;
      Homography result;
      result.header = header;
      result.state = Homography::TRACKING;
      result.corners = {103, 60, 202, 60, 202, 159, 103, 159};
      bag.write("/camera/image_raw", time, *cv_bridge::CvImage(header, "bgr8", picture).toImageMsg());
      bag.write("/tracker/homography", time + ros::Duration(0.02), result);
      time += ros::Duration(0.04);
    }
  }
  // Plays when the tracker and this test receive the images, and this test the results: none is lost then.
  void play(const std::string& arguments) {
    launch("subscribers:=2 " + arguments);
    ASSERT_TRUE(spinUntil([this] { return results_->connected(); }, kLongest)) << contents(log());
    images_ = std::make_unique<Recorder<sensor_msgs::Image>>(node_, "/camera/image_raw");
  }
  void launch(const std::string& arguments) {
    images_.reset();
    results_ = std::make_unique<Recorder<Homography>>(node_, "/tracker/homography");
    const std::string command =
        "cd " + folder_.file("") +
        " && ROSCONSOLE_STDOUT_LINE_BUFFERED=1 exec roslaunch laparoscope_servo replay.launch rviz:=false " + arguments;
    launch_ = std::make_unique<ChildProcess>("/bin/sh", std::vector<std::string>{"-c", command}, log());
  }
  bool ends() {
    return spinUntil([this] { return !launch_->isRunning(); }, kLongest);
  }
  void end() {
    launch_->kill(SIGINT);
    EXPECT_TRUE(ends()) << contents(log());
  }
  std::string log() const { return folder_.file("log"); }

  test_support::TemporaryFolder folder_;
  ros::NodeHandle node_;
  std::unique_ptr<Recorder<Homography>> results_;
  std::unique_ptr<Recorder<sensor_msgs::Image>> images_;
  std::unique_ptr<ChildProcess> launch_;
};

TEST_F(ReplayLaunch, EndsWhenThePlayerFails) {
  std::ofstream(folder_.file("film.mp4")) << "no film";
  launch("video:=" + folder_.file("film.mp4"));
  EXPECT_TRUE(ends()) << "tracker and player stay as if there were images to come";
  EXPECT_NE(contents(log()).find("film.mp4' cannot be opened"), std::string::npos) << contents(log());
  EXPECT_TRUE(results_->all.empty());
}

TEST_F(ReplayLaunch, SaysWhereItHasLookedForARelativePath) {
  launch("video:=no_film.mp4");
  EXPECT_TRUE(ends());
  EXPECT_NE(contents(log()).find(folder_.file("no_film.mp4") + "' does not exist"), std::string::npos)
      << contents(log());
}

TEST_F(ReplayLaunch, StaysAtTheEndOfTheRecordingUntilItIsEnded) {
  play("video:=" + folder() + " roi:=100,60,100,100");
  ASSERT_TRUE(spinUntil([this] { return contents(log()).find("played 5 images") != std::string::npos; }, kLongest))
      << contents(log());
  EXPECT_TRUE(spinUntil([this] { return results_->all.size() == kImages; }, kLongest));
  EXPECT_TRUE(launch_->isRunning());
  EXPECT_TRUE(results_->connected()) << "the tracker is there";
  end();
}

// The bag of a case, in which the tracker had said something else: the region 3 px further to the right.
TEST_F(ReplayLaunch, PlaysWhatWasRecordedBesideWhatIsComputedNow) {
  writeCase();
  Recorder<Homography> recorded(node_, "/recorded/tracker/homography");
  play("stay:=false roi:=100,60,100,100 bag:='cas*.bag'");  // relative to the folder where roslaunch is called
  ASSERT_TRUE(ends()) << contents(log());
  ASSERT_EQ(results_->all.size(), static_cast<std::size_t>(kImages)) << contents(log());
  ASSERT_EQ(recorded.all.size(), static_cast<std::size_t>(kImages)) << contents(log());
  for (std::size_t k = 0; k < kImages; ++k) {
    EXPECT_EQ(recorded.all[k]->header.stamp, results_->all[k]->header.stamp);
    EXPECT_EQ(results_->all[k]->state, Homography::TRACKING);
    EXPECT_NEAR(cornersApart(recorded.all[k]->corners, results_->all[k]->corners), 3.0, 0.5);
  }
}

// Parameters outlive their nodes in a master: a region that nobody asked for would be tracked, and a key that was taken
// out of a file would still hold.
TEST_F(ReplayLaunch, NothingOfTheRunBeforeHoldsInTheNext) {
  std::ofstream(folder_.file("params.yaml")) << "tracking: {esm: {levels: 1}}\n";
  play("stay:=false roi:=100,60,100,100 params:=" + folder_.file("params.yaml") + " video:=" + folder());
  ASSERT_TRUE(ends()) << contents(log());
  ASSERT_EQ(results_->all.size(), static_cast<std::size_t>(kImages)) << contents(log());
  EXPECT_EQ(results_->all.back()->state, Homography::TRACKING);
  ASSERT_TRUE(ros::param::has("/tracker/roi")) << "the master lives on with what the run set";
  int levels = 0;
  ASSERT_TRUE(ros::param::get("/tracker/tracking/esm/levels", levels) && levels == 1);
  ros::param::set("/tracker/tracking/esm/no_such_parameter", 1);  // a misspelt one of before, that is refused
  ros::param::set("/player/start", 100.0);

  play("stay:=false video:=" + folder_.file("images"));
  ASSERT_TRUE(ends()) << contents(log());
  ASSERT_EQ(results_->all.size(), static_cast<std::size_t>(kImages)) << contents(log());
  for (const auto& result : results_->all) EXPECT_EQ(result->state, Homography::IDLE);
  EXPECT_FALSE(ros::param::has("/tracker/roi"));
  EXPECT_FALSE(ros::param::has("/tracker/tracking/esm/no_such_parameter"));
  ASSERT_TRUE(ros::param::get("/tracker/tracking/esm/levels", levels));
  EXPECT_NE(levels, 1);
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "replay_launch_test");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
