// The offline tool with inputs and outputs that fail: what it says, its exit status, what is in the outputs.
#include <cv_bridge/cv_bridge.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "ros/playback/image_source.h"
#include "support/synthetic_sequence.h"
#include "support/temporary_folder.h"
#include "support/test_video.h"
#include "support/tracker_table.h"
#include "system/aesop/child_process.h"

namespace laparoscope_servo {
namespace {

namespace fs = std::filesystem;
using test_support::bytesOf;

constexpr int kImages = 12;

class TrackBagFaults : public testing::Test {
 protected:
  TrackBagFaults() {
    const cv::Mat texture = test_support::texture(cv::Size(160, 120));
    for (const Eigen::Matrix3d& g : test_support::motion(kImages, {50.0, 40.0, 50.0, 40.0}, 3.0)) {
      images_.push_back(test_support::view(texture, g));
    }
  }

  static std::vector<std::string> arguments(const std::vector<std::string>& inputs) {
    std::vector<std::string> all = inputs;
    all.insert(all.end(), {"--roi", "50,40,50,40"});
    return all;
  }
  int run(const std::string& rest, const std::string& before = "") {
    const std::string command = before + TRACK_BAG " --roi 50,40,50,40 " + rest + " 2> " + out_.file("stderr");
    const int status = std::system(command.c_str());
    said_ = bytesOf(out_.file("stderr"));
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  bool says(const std::string& part) const { return said_.find(part) != std::string::npos; }

  std::string video(const std::string& name, const test_support::TestVideo& video = {}) {
    test_support::writeVideo(in_.file(name), images_, video);
    return in_.file(name);
  }
  std::string folder(int count) {
    fs::create_directory(in_.file("images"));
    const auto name = [this](int k) { return in_.file("images/frame" + std::to_string(k) + ".png"); };
    for (int k = 0; k < count; ++k) {
      if (k < kImages) cv::imwrite(name(k), images_[static_cast<std::size_t>(k)]);
      if (k >= kImages) fs::create_hard_link(name(k % kImages), name(k));
    }
    return in_.file("images");
  }
  std::string bag(const std::string& name, int from, int to, const std::function<ros::Time(int)>& stamp) {
    rosbag::Bag bag(in_.file(name), rosbag::bagmode::Write);
    for (int k = from; k < to; ++k) {
      cv_bridge::CvImage image;
      image.header.stamp = stamp(k);
      image.encoding = "bgr8";
      image.image = images_[static_cast<std::size_t>(k)];
      bag.write("/image_raw", ros::Time(100.0 + 0.04 * k), *image.toImageMsg());
    }
    return in_.file(name);
  }

  std::vector<std::string> rows(const std::string& name = "out.csv") const {
    std::vector<std::string> result;
    std::ifstream file(out_.file(name));
    for (std::string line; std::getline(file, line);) result.push_back(line);
    return result;
  }
  std::string allOutputs() const {
    return " --csv " + out_.file("out.csv") + " --output " + out_.file("out.bag") + " --overlay " +
           out_.file("out.mp4");
  }
  // All that is in the folder of the outputs, besides what was said.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(out_.path())) {
      if (entry.path().filename() != "stderr") names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  // Outputs that can be read to their end, with a line, a message and a picture for each image.
  void expectWholeOutputs(std::size_t images) const {
    EXPECT_EQ(files(), (std::vector<std::string>{"out.bag", "out.csv", "out.mp4"}));
    EXPECT_EQ(rows().size(), images + 1);
    EXPECT_EQ(bytesOf(out_.file("out.csv")).back(), '\n');
    rosbag::Bag bag(out_.file("out.bag"));
    EXPECT_EQ(rosbag::View(bag, rosbag::TopicQuery("/tracker/homography")).size(), images);
    const auto source = openImageSource(out_.file("out.mp4"), {});
    std::size_t pictures = 0;
    while (const auto picture = source->next()) pictures += picture->error.empty() ? 1 : 0;
    EXPECT_EQ(pictures, images);
  }

  test_support::TemporaryFolder in_;
  test_support::TemporaryFolder out_;
  std::vector<cv::Mat> images_;
  std::string said_;
};

TEST_F(TrackBagFaults, AVideoThatBreaksOffIsNoSuccess) {
  const std::string whole = video("film.mkv");
  ASSERT_EQ(run(whole + allOutputs()), 0) << said_;
  expectWholeOutputs(kImages);
  const auto places = test_support::packetsOf(whole);
  test_support::writeBytes(whole, bytesOf(whole).substr(0, places[8].at + 3));
  EXPECT_EQ(run(whole + allOutputs()), 1) << said_;
  EXPECT_TRUE(says("breaks off at 0.320 s")) << said_;
  EXPECT_TRUE(says("4 of 12 images")) << said_;
  expectWholeOutputs(8);
}

TEST_F(TrackBagFaults, ADamagedPictureIsNamedAndTheRestIsTracked) {
  test_support::TestVideo mjpeg;
  mjpeg.codec = "mjpeg";
  mjpeg.pixels = AV_PIX_FMT_YUVJ420P;
  const std::string film = video("film.mkv", mjpeg);
  const auto places = test_support::packetsOf(film);
  std::string bytes = bytesOf(film);
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(places[5].at), places[5].size, '\x5A');
  test_support::writeBytes(film, bytes);
  EXPECT_EQ(run(film + allOutputs()), 1) << said_;
  EXPECT_TRUE(says("image 5 is left out: at 0.200 s of")) << said_;
  EXPECT_TRUE(says("1 of 12 images")) << said_;
  expectWholeOutputs(11);
  EXPECT_EQ(rows()[6].substr(0, 2), "6,");
}

TEST_F(TrackBagFaults, AHalfImageInAFolderIsNamed) {
  const std::string images = folder(4);
  for (const char* ending : {"png", "jpg", "bmp", "tif", "pgm", "webp"}) {
    SCOPED_TRACE(ending);
    const std::string half = in_.file(std::string("images/frame10.") + ending);
    cv::Mat grey;
    cv::extractChannel(images_[0], grey, 0);
    cv::imwrite(half, std::string(ending) == "pgm" ? grey : images_[0]);
    fs::resize_file(half, fs::file_size(half) * 6 / 10);
    EXPECT_EQ(run(images + " --csv " + out_.file("out.csv")), 1) << said_;
    EXPECT_TRUE(says("image 4 is left out: '" + half)) << said_;
    EXPECT_EQ(rows().size(), 5u);
    fs::remove(half);
  }
}

// The end of the input as it were: what was processed is kept, whole, and nobody takes it for all.
TEST_F(TrackBagFaults, ASignalEndsTheOutputsProperly) {
  const std::string images = folder(3000);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    SCOPED_TRACE(strsignal(signal));
    std::vector<std::string> all = arguments({images});
    all.insert(all.end(),
               {"--csv", out_.file("out.csv"), "--output", out_.file("out.bag"), "--overlay", out_.file("out.mp4")});
    test::ChildProcess tool(TRACK_BAG, all, out_.file("stderr"));
    const auto partial = out_.file("out.csv.partial");
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (tool.isRunning() && std::chrono::steady_clock::now() < end &&
           !(fs::exists(partial) && fs::file_size(partial) > 5000)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ASSERT_TRUE(tool.isRunning()) << bytesOf(out_.file("stderr"));
    tool.kill(signal);
    EXPECT_EQ(tool.exitStatus(30.0), 128 + signal);
    said_ = bytesOf(out_.file("stderr"));
    EXPECT_TRUE(says(std::string("ended by ") + strsignal(signal))) << said_;
    const std::size_t images_done = rows().size() - 1;
    EXPECT_GT(images_done, 5u);
    EXPECT_LT(images_done, 3000u);
    EXPECT_TRUE(says("after " + std::to_string(images_done) + " images")) << said_;
    expectWholeOutputs(images_done);
    for (const char* name : {"out.csv", "out.bag", "out.mp4"}) fs::remove(out_.file(name));
  }
}

TEST_F(TrackBagFaults, AFullDiskLeavesEarlierResultsAndNoHalfOnes) {
  const std::string images = folder(400);
  for (const char* name : {"out.csv", "out.bag", "out.mp4"}) std::ofstream(out_.file(name)) << "earlier";
  for (const char* option : {"--csv ", "--output ", "--overlay "}) {
    const std::string name = std::string("out.") + (option[2] == 'c' ? "csv" : option[3] == 'u' ? "bag" : "mp4");
    // 32 KiB for each file; each grows beyond.
    EXPECT_EQ(run(images + " " + option + out_.file(name), "ulimit -f 32; "), 1) << said_;
    EXPECT_TRUE(says("'" + out_.file(name) + "' cannot be written")) << said_;
    EXPECT_EQ(bytesOf(out_.file(name)), "earlier");
    EXPECT_EQ(files().size(), 3u);
  }
  EXPECT_EQ(run(images + " --csv /dev/full"), 1);
  EXPECT_TRUE(says("'/dev/full' cannot be written") && says("No space left")) << said_;
}

TEST_F(TrackBagFaults, PartsOfARecordingAreOneInTheOrderOfTime) {
  const auto stamp = [](int k) { return ros::Time(50.0 + 0.04 * k); };
  const std::string whole = bag("whole.bag", 0, kImages, stamp);
  const std::string first = bag("part_0.bag", 0, 5, stamp);
  const std::string second = bag("part_1.bag", 5, kImages, stamp);
  ASSERT_EQ(run(whole + " --csv " + out_.file("whole.csv")), 0) << said_;
  ASSERT_EQ(run(second + " " + first + " --csv " + out_.file("parts.csv")), 0) << said_;
  const auto one = rows("whole.csv");
  const auto parts = rows("parts.csv");
  ASSERT_EQ(one.size(), kImages + 1u);
  ASSERT_EQ(parts.size(), one.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(test_support::withoutTime(one[k]), test_support::withoutTime(parts[k]));
  }
  EXPECT_EQ(run(first + " " + in_.path() + " --csv " + out_.file("x.csv")), 1);
  EXPECT_TRUE(says("is no bag, expected bags")) << said_;
}

TEST_F(TrackBagFaults, StampsThatStandForNothingAreThoseOfTheRecording) {
  struct Case {
    const char* name;
    std::function<ros::Time(int)> stamp;
    int replaced;
    double first;
  };
  for (const Case& c :
       {Case{"zero.bag", [](int) { return ros::Time(); }, kImages, 100.0},
        Case{"same.bag", [](int) { return ros::Time(7.0); }, kImages - 1, 7.0},
        Case{"some.bag", [](int k) { return k % 4 == 3 ? ros::Time() : ros::Time(50.0 + 0.04 * k); }, 3, 50.0}}) {
    SCOPED_TRACE(c.name);
    ASSERT_EQ(run(bag(c.name, 0, kImages, c.stamp) + " --csv " + out_.file("out.csv")), 0) << said_;
    EXPECT_TRUE(says("note: " + std::to_string(c.replaced) + " images have the stamp 0 or that of the image before"))
        << said_;
    const auto table = rows();
    ASSERT_EQ(table.size(), kImages + 1u);
    for (int k = 0; k < kImages; ++k) {
      const std::string& row = table[static_cast<std::size_t>(k) + 1];
      EXPECT_NEAR(std::stod(row.substr(row.find(',') + 1)), c.first + 0.04 * k, 1e-6);
      EXPECT_EQ(row.substr(row.find(',', row.find(',') + 1), 3), ",1,") << "TRACKING: " << row;
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo
