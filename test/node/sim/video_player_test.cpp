// The video player as a process, with files that the test makes.
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/CompressedImage.h>

#include <algorithm>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "laparoscope_servo/ControlPlayback.h"
#include "laparoscope_servo/Homography.h"
#include "laparoscope_servo/PlaybackState.h"
#include "node_bench.h"
#include "ros/tracker/result_messages.h"

namespace laparoscope_servo::test {
namespace {

constexpr int kImages = 6;

// Images that tell which one they are by their grey.
cv::Mat image(int k) {
  return {48, 64, CV_8UC3, cv::Scalar::all(30 + 20 * k)};
}
int numberOf(const sensor_msgs::Image& message) {
  return (message.data[message.data.size() / 2] - 25) / 20;
}

class VideoPlayer : public testing::Test {
 protected:
  ~VideoPlayer() override { ros::param::del("/player"); }

  std::string folder() {
    std::filesystem::create_directory(folder_.file("images"));
    for (int k = 0; k < kImages; ++k) cv::imwrite(folder_.file("images/" + std::to_string(k) + ".png"), image(k));
    return folder_.file("images");
  }
  std::string video() {
    const std::string file = folder_.file("video.avi");
    cv::VideoWriter writer(file, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 50.0, {64, 48});
    for (int k = 0; k < kImages; ++k) writer.write(image(k));
    return file;
  }
  std::string bag(bool compressed) {
    const std::string file = folder_.file("images.bag");
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    for (int k = 0; k < kImages; ++k) {
      std_msgs::Header header;
      header.stamp = ros::Time(1500000000, static_cast<std::uint32_t>(20000003 * (k + 1)));
      header.frame_id = "camera_of_the_bag";
      const ros::Time recorded = header.stamp + ros::Duration(0.001);
      sensor_msgs::CameraInfo info;
      info.header = header;
      info.width = 64;
      info.height = 48;
      info.K[0] = info.K[4] = 77.0;
      bag.write("/scope/camera_info", recorded, info);
      if (compressed) {
        sensor_msgs::CompressedImage message;
        message.header = header;
        message.format = "bgr8; png compressed bgr8";
        cv::imencode(".png", image(k), message.data);
        bag.write("/scope/image_raw/compressed", recorded, message);
      } else {
        bag.write("/scope/image_raw", recorded, *imageMessage(header, image(k)));
      }
    }
    return file;
  }
  std::string calibration(int width) {
    const std::string file = folder_.file("calibration.yaml");
    std::ofstream(file) << "image_width: " << width << "\nimage_height: 48\ncamera_name: scope\n"
                        << "camera_matrix: {rows: 3, cols: 3, data: [90, 0, 31, 0, 91, 23, 0, 0, 1]}\n"
                        << "distortion_model: plumb_bob\n"
                        << "distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}\n"
                        << "rectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}\n"
                        << "projection_matrix: {rows: 3, cols: 4, data: [90, 0, 31, 0, 0, 91, 23, 0, 0, 0, 1, 0]}\n";
    return file;
  }

  void start(const std::string& file) {
    // A listener left over would be one for whom the player does not wait.
    images_.reset();
    infos_.reset();
    clock_.reset();
    parameters_["video"] = file;
    ros::param::set("/player", parameters_);
    player_ = std::make_unique<ChildProcess>(VIDEO_PLAYER, std::vector<std::string>{"__name:=player"}, log());
  }
  // Listens only once the player has been there for a while: it has to wait.
  void listen() {
    ASSERT_TRUE(spinUntil([] {
      ros::master::V_TopicInfo topics;
      ros::master::getTopics(topics);
      return std::any_of(topics.begin(), topics.end(), [](const auto& topic) { return topic.name == "/image_raw"; });
    }));
    clock_ = std::make_unique<Recorder<rosgraph_msgs::Clock>>(node_, "/clock");
    infos_ = std::make_unique<Recorder<sensor_msgs::CameraInfo>>(node_, "camera_info");
    ASSERT_TRUE(spinUntil([this] { return clock_->connected() && infos_->connected(); }));
    images_ = std::make_unique<Recorder<sensor_msgs::Image>>(node_, "image_raw");
  }
  void play(const std::string& file) {
    start(file);
    ASSERT_NO_FATAL_FAILURE(listen());
    ASSERT_TRUE(spinUntil([this] { return images_->all.size() >= kImages && infos_->all.size() >= kImages; }));
    EXPECT_EQ(player_->exitStatus(5.0), 0);
    ros::spinOnce();
    ASSERT_EQ(images_->all.size(), static_cast<std::size_t>(kImages));
    for (int k = 0; k < kImages; ++k) EXPECT_EQ(numberOf(*images_->all[static_cast<std::size_t>(k)]), k);
  }
  void expectRefusal(const std::string& file, const std::string& part) {
    parameters_["subscribers"] = 0;
    start(file);
    EXPECT_EQ(player_->exitStatus(10.0), 1);
    EXPECT_NE(contents(log()).find(part), std::string::npos) << part << " in\n" << contents(log());
  }
  std::string log() const { return folder_.file("player.log"); }
  ros::Time stamp(std::size_t k) const { return images_->all[k]->header.stamp; }
  static bool control(const std::string& command, double position = 0.0) {
    ControlPlayback call;
    call.request.command = command;
    call.request.position = position;
    return ros::service::call("player/control", call) && call.response.success;
  }

  test_support::TemporaryFolder folder_;
  ros::NodeHandle node_;
  XmlRpc::XmlRpcValue parameters_;
  std::unique_ptr<ChildProcess> player_;
  std::unique_ptr<Recorder<sensor_msgs::Image>> images_;
  std::unique_ptr<Recorder<sensor_msgs::CameraInfo>> infos_;
  std::unique_ptr<Recorder<rosgraph_msgs::Clock>> clock_;
};

TEST_F(VideoPlayer, PlaysAFolderFromItsFirstImageWithStampsByNumber) {
  parameters_["fps"] = 50.0;
  ASSERT_NO_FATAL_FAILURE(play(folder()));
  for (std::size_t k = 0; k < kImages; ++k) {
    EXPECT_NEAR(stamp(k).toSec(), 1.0 + 0.02 * static_cast<double>(k), 1e-8);
    EXPECT_EQ(images_->all[k]->header.frame_id, "laparoscope_optical");
    EXPECT_EQ(infos_->all[k]->header.stamp, stamp(k));
    EXPECT_EQ(infos_->all[k]->K[0], 0.0) << "intrinsics that nobody knows";
  }
  ASSERT_GE(clock_->all.size(), static_cast<std::size_t>(kImages));
  for (std::size_t k = 1; k < clock_->all.size(); ++k) EXPECT_GE(clock_->all[k]->clock, clock_->all[k - 1]->clock);
  EXPECT_EQ(clock_->all.back()->clock, stamp(kImages - 1));
}

TEST_F(VideoPlayer, PlaysAVideoAtItsOwnRateWhateverTheSpeed) {
  parameters_["speed"] = 3.0;
  ASSERT_NO_FATAL_FAILURE(play(video()));
  for (std::size_t k = 0; k < kImages; ++k) EXPECT_NEAR(stamp(k).toSec(), 1.0 + 0.02 * static_cast<double>(k), 1e-8);
}

TEST_F(VideoPlayer, PlaysABagWithItsOwnHeadersAndIntrinsics) {
  for (const bool compressed : {false, true}) {
    SCOPED_TRACE(compressed);
    ASSERT_NO_FATAL_FAILURE(play(bag(compressed)));
    for (std::size_t k = 0; k < kImages; ++k) {
      EXPECT_EQ(stamp(k), ros::Time(1500000000, static_cast<std::uint32_t>(20000003 * (k + 1))));
      EXPECT_EQ(images_->all[k]->header.frame_id, "camera_of_the_bag");
      EXPECT_EQ(infos_->all[k]->K[0], 77.0);
      EXPECT_EQ(infos_->all[k]->header.stamp, stamp(k));
    }
    EXPECT_EQ(clock_->all.back()->clock, stamp(kImages - 1) + ros::Duration(0.001));
  }
}

TEST_F(VideoPlayer, TimeJumpsBackAtALoopUnlessItIsToGoOn) {
  parameters_["loop"] = true;
  parameters_["fps"] = 100.0;
  const std::string images = folder();
  for (const bool restart : {true, false}) {
    parameters_["restart_time"] = restart;
    start(images);
    ASSERT_NO_FATAL_FAILURE(listen());
    ASSERT_TRUE(spinUntil([this] { return images_->all.size() > kImages; }));
    EXPECT_EQ(numberOf(*images_->all[kImages]), 0);
    EXPECT_NEAR(stamp(kImages).toSec(), restart ? 1.0 : 1.0 + 0.01 * kImages, 1e-8);
    player_->kill(SIGINT);
    player_->exitStatus(5.0);
  }
}

// Where playback was paused on the way, too: the stamps go on behind the last image.
TEST_F(VideoPlayer, TimeGoesOnAtALoopAfterAPauseToo) {
  parameters_["loop"] = true;
  parameters_["restart_time"] = false;
  parameters_["fps"] = 100.0;
  start(folder());
  ASSERT_NO_FATAL_FAILURE(listen());
  ASSERT_TRUE(spinUntil([this] { return !images_->all.empty(); }));
  ASSERT_TRUE(control("PAUSE"));
  const auto number = [this] { return numberOf(*images_->all.back()); };
  for (std::size_t on_the_way = 0; on_the_way != images_->all.size();) {
    on_the_way = images_->all.size();
    ASSERT_LT(on_the_way, 20u * kImages) << "it is not paused";
    spinUntil([&] { return images_->all.size() > on_the_way; }, 0.2);
  }
  for (int k = 0; k < 2 * kImages && number() != 3; ++k) {
    const std::size_t before = images_->all.size();
    EXPECT_TRUE(control("STEP"));
    ASSERT_TRUE(spinUntil([&] { return images_->all.size() > before; }));
  }
  ASSERT_EQ(number(), 3);
  const std::size_t paused = images_->all.size();
  EXPECT_TRUE(control("PLAY"));
  ASSERT_TRUE(spinUntil([&] { return images_->all.size() > paused + kImages; }));
  for (std::size_t k = 1; k < images_->all.size(); ++k) EXPECT_NEAR((stamp(k) - stamp(k - 1)).toSec(), 0.01, 1e-8) << k;
}

TEST_F(VideoPlayer, InLockstepWaitsForTheTracker) {
  parameters_["fps"] = 200.0;
  parameters_["lockstep"] = true;
  ros::Publisher tracker = node_.advertise<Homography>("homography", 10);
  start(folder());
  ASSERT_NO_FATAL_FAILURE(listen());
  for (std::size_t k = 0; k < kImages; ++k) {
    ASSERT_TRUE(spinUntil([&] { return images_->all.size() > k; }));
    // Many times the period of the images.
    EXPECT_FALSE(spinUntil([&] { return images_->all.size() > k + 1; }, 0.1));
    Homography result;
    result.header = images_->all[k]->header;
    tracker.publish(result);
  }
  EXPECT_EQ(player_->exitStatus(5.0), 0);
}

// A result is known by its image's stamp, which therefore has to be one.
TEST_F(VideoPlayer, InLockstepImagesWithoutStampsWaitForTheirResultsToo) {
  const std::string file = folder_.file("zero.bag");
  {
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    for (int k = 0; k < kImages; ++k)
      bag.write("/image_raw", ros::Time(100.0 + 0.005 * k), *imageMessage({}, image(k)));
  }
  parameters_["lockstep"] = true;
  ros::Publisher tracker = node_.advertise<Homography>("homography", 10);
  start(file);
  ASSERT_NO_FATAL_FAILURE(listen());
  for (std::size_t k = 0; k < kImages; ++k) {
    ASSERT_TRUE(spinUntil([&] { return images_->all.size() > k; }));
    EXPECT_FALSE(spinUntil([&] { return images_->all.size() > k + 1; }, 0.1));
    EXPECT_NEAR(stamp(k).toSec(), 100.0 + 0.005 * static_cast<double>(k), 1e-6);
    Homography result;
    result.header = images_->all[k]->header;
    tracker.publish(result);
  }
  EXPECT_EQ(player_->exitStatus(5.0), 0);
  EXPECT_NE(contents(log()).find("6 images have the stamp 0"), std::string::npos) << contents(log());
}

TEST_F(VideoPlayer, HoldsItsFirstImageUntilARegionIsSelectedAndGoesOnAsItIsTold) {
  parameters_["fps"] = 50.0;
  parameters_["speed"] = 0.5;
  parameters_["hold"] = true;
  parameters_["stay"] = true;
  parameters_["wait_for_screen"] = true;
  ros::Publisher tracker = node_.advertise<Homography>("homography", 10);
  const auto track = [&](int state) {
    Homography result;
    result.state = static_cast<std::uint8_t>(state);
    tracker.publish(result);
  };
  start(folder());
  ASSERT_NO_FATAL_FAILURE(listen());
  EXPECT_FALSE(spinUntil([&] { return !images_->all.empty(); }, 0.3)) << "nobody looks at it";
  Recorder<PlaybackState> states(node_, "player/state");
  const auto state = [&] { return states.all.empty() ? std::string() : states.all.back()->state; };
  const auto number = [&] { return images_->all.empty() ? -1 : numberOf(*images_->all.back()); };
  ASSERT_TRUE(spinUntil([&] { return images_->all.size() >= 3; })) << "again and again";
  EXPECT_EQ(state(), PlaybackState::HOLDING);
  EXPECT_EQ(number(), 0);
  EXPECT_LT(stamp(0), stamp(1));
  EXPECT_LT(stamp(2).toSec() - stamp(0).toSec(), 0.001) << "before the next one";
  track(Homography::TRACKING);
  ASSERT_TRUE(spinUntil([&] { return state() == PlaybackState::ENDED; }));
  EXPECT_EQ(number(), kImages - 1);
  EXPECT_NEAR(states.all.back()->duration, kImages / 50.0, 1e-9);
  EXPECT_NEAR(states.all.back()->period, 0.04, 1e-9) << "in real time";

  EXPECT_FALSE(control("PLAY")) << "it has ended";
  EXPECT_TRUE(control("SEEK", 2.0 / 50.0));
  EXPECT_TRUE(spinUntil([&] { return state() == PlaybackState::PAUSED && number() == 2; })) << number();
  EXPECT_TRUE(control("STEP"));
  EXPECT_TRUE(spinUntil([&] { return number() == 3; }));
  EXPECT_FALSE(spinUntil([&] { return number() != 3; }, 0.2));
  EXPECT_TRUE(control("SEEK", 1e6)) << "beyond the end";
  EXPECT_TRUE(spinUntil([&] { return state() == PlaybackState::ENDED; }));
  const std::size_t before = images_->all.size();
  EXPECT_TRUE(control("AGAIN"));
  EXPECT_TRUE(spinUntil([&] { return images_->all.size() >= before + kImages && state() == PlaybackState::ENDED; }));
  EXPECT_EQ(number(), kImages - 1);
  EXPECT_TRUE(player_->isRunning());
}

// Where a screen is, it is said there, and a file that is repaired meanwhile is played.
TEST_F(VideoPlayer, SaysOnItsStateWhatCannotBeReadAndTriesAgain) {
  parameters_["stay"] = true;
  parameters_["wait_for_screen"] = true;
  const std::string whole = bag(true), cut = folder_.file("cut.bag");
  std::filesystem::copy_file(whole, cut);
  std::filesystem::resize_file(cut, std::filesystem::file_size(whole) / 2);
  start(cut);
  ASSERT_NO_FATAL_FAILURE(listen());
  Recorder<PlaybackState> states(node_, "player/state");
  const auto is = [&](const std::string& state) {
    return spinUntil([&] { return !states.all.empty() && states.all.back()->state == state; });
  };
  ASSERT_TRUE(is(PlaybackState::FAILED)) << contents(log());
  EXPECT_NE(states.all.back()->reason.find("cut.bag' breaks off"), std::string::npos) << states.all.back()->reason;
  EXPECT_FALSE(control("PLAY"));
  const std::size_t before = states.all.size();
  EXPECT_TRUE(control("AGAIN"));
  EXPECT_TRUE(spinUntil([&] { return states.all.size() > before; }));
  EXPECT_TRUE(is(PlaybackState::FAILED)) << "it is as it was";
  std::filesystem::copy_file(whole, cut, std::filesystem::copy_options::overwrite_existing);
  EXPECT_TRUE(control("AGAIN"));
  ASSERT_TRUE(is(PlaybackState::ENDED)) << contents(log());
  EXPECT_EQ(images_->all.size(), static_cast<std::size_t>(kImages));
  EXPECT_EQ(states.all.back()->reason, "");
  player_->kill(SIGINT);
  EXPECT_EQ(player_->exitStatus(20.0), 0);
}

TEST_F(VideoPlayer, EndsWithStatusOneWhatCouldNotBeRead) {
  parameters_["stay"] = true;
  parameters_["wait_for_screen"] = true;
  start(folder_.file("missing.mp4"));
  Recorder<PlaybackState> states(node_, "player/state");
  ASSERT_TRUE(spinUntil([&] { return !states.all.empty() && states.all.back()->state == PlaybackState::FAILED; }));
  player_->kill(SIGINT);
  EXPECT_EQ(player_->exitStatus(20.0), 1);
}

TEST_F(VideoPlayer, TakesIntrinsicsFromACalibration) {
  parameters_["camera_info"] = calibration(64);
  ASSERT_NO_FATAL_FAILURE(play(video()));
  EXPECT_EQ(infos_->all[0]->K[0], 90.0);
  EXPECT_EQ(infos_->all[0]->header.stamp, stamp(0));
}

TEST_F(VideoPlayer, RefusesACalibrationForImagesOfAnotherSize) {
  parameters_["camera_info"] = calibration(128);
  expectRefusal(video(), "is for images of 128x48 px");
}

TEST_F(VideoPlayer, RefusesWhatItCannotPlayAndSaysWhy) {
  expectRefusal(folder_.file("missing.mp4"), "missing.mp4' does not exist");
  std::ofstream(folder_.file("text.mp4")) << "no video";
  expectRefusal(folder_.file("text.mp4"), "text.mp4' cannot be opened");
  std::filesystem::create_directory(folder_.file("empty"));
  expectRefusal(folder_.file("empty"), "has no images");
  parameters_["start"] = 100.0;
  expectRefusal(video(), "has no image after 100");
  parameters_["start"] = 0.0;
  parameters_["image_topic"] = "/wrong";
  expectRefusal(bag(false), "/scope/image_raw (sensor_msgs/Image)");
}

TEST_F(VideoPlayer, ListsAllErrorsInItsParameters) {
  parameters_["speed"] = 0.0;
  parameters_["loop"] = "yes";
  parameters_["lop"] = true;
  expectRefusal(folder(), "player/speed");
  for (const char* part : {"player/loop", "player/lop is no parameter"}) {
    EXPECT_NE(contents(log()).find(part), std::string::npos) << contents(log());
  }
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "video_player_test");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
