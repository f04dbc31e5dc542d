// The offline tool as a user runs it: arguments, exit status, what it says.
#include <cv_bridge/cv_bridge.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/String.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>

#include "support/feature_scene.h"
#include "support/synthetic_sequence.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

constexpr int kSuccess = 0;
constexpr int kFailure = 1;
constexpr int kBadUsage = 2;

class TrackBag : public testing::Test {
 protected:
  TrackBag() {
    const cv::Mat texture = test_support::texture(cv::Size(160, 120));
    const geometry::Rectangle roi{50.0, 40.0, 50.0, 40.0};
    int k = 0;
    for (const Eigen::Matrix3d& g : test_support::motion(4, roi, 3.0)) {
      cv::imwrite(images_.file(std::to_string(k++) + ".png"), test_support::view(texture, g));
    }
  }

  // No master at the address given: the tool needs none.
  int run(const std::string& arguments) {
    const std::string command = "ROS_MASTER_URI=http://localhost:1 " TRACK_BAG " " + arguments + " > " +
                                out_.file("stdout") + " 2> " + out_.file("stderr");
    const int status = std::system(command.c_str());
    stdout_ = content(out_.file("stdout"));
    stderr_ = content(out_.file("stderr"));
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  static std::string content(const std::string& path) {
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }

  bool says(const std::string& part) const { return stderr_.find(part) != std::string::npos; }

  test_support::TemporaryFolder images_;
  test_support::TemporaryFolder out_;
  std::string stdout_;
  std::string stderr_;
};

TEST_F(TrackBag, WritesTheTableAndEndsWithZero) {
  ASSERT_EQ(run(images_.path() + " --roi 50,40,50,40 --csv " + out_.file("out.csv")), kSuccess) << stderr_;
  const std::string table = content(out_.file("out.csv"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 5);
  EXPECT_EQ(table.substr(0, table.find('\n')),
            "frame,stamp,state,g00,g01,g02,g10,g11,g12,g20,g21,g22,visible_fraction,zncc,iterations,processing_time"
            ",corner_error,centre_error,gain,bias,reason");
  EXPECT_TRUE(says("4 images: TRACKING")) << stderr_;
  EXPECT_EQ(stdout_, "");
  EXPECT_EQ(stderr_.find('\r'), std::string::npos) << "no progress line in a log";
}

TEST_F(TrackBag, ReadsABagAndWritesABagAndAVideo) {
  const std::string input = out_.file("in.bag");
  {
    rosbag::Bag bag(input, rosbag::bagmode::Write);
    for (int k = 0; k < 4; ++k) {
      cv_bridge::CvImage image;
      image.header.stamp = ros::Time(100.0 + 0.04 * k);
      image.encoding = "bgr8";
      image.image = cv::imread(images_.file(std::to_string(k) + ".png"));
      bag.write("/scope/image_raw", image.header.stamp, *image.toImageMsg());
      bag.write("/other", image.header.stamp, std_msgs::String());
    }
  }
  const std::string output = out_.file("out.bag");
  const std::string video = out_.file("out.mp4");
  ASSERT_EQ(run(input + " --roi 50,40,50,40 --image-topic /scope/image_raw --output " + output + " --overlay " + video),
            kSuccess)
      << stderr_;
  EXPECT_GT(content(output).size(), 1000u);
  EXPECT_GT(content(video).size(), 1000u);
  EXPECT_EQ(run(input + " --roi 50,40,50,40 --image-topic /other"), kFailure);
  EXPECT_TRUE(says("/scope/image_raw (sensor_msgs/Image)")) << stderr_;
}

TEST_F(TrackBag, LaysAParameterFileOverTheDefaults) {
  std::ofstream(out_.file("good.yaml")) << "roi: [1]\n";
  EXPECT_EQ(run(images_.path() + " --params " + out_.file("good.yaml")), kFailure);
  EXPECT_TRUE(says("roi")) << stderr_;
  std::ofstream(out_.file("roi.yaml")) << "roi: {x: 50, y: 40, width: 50, height: 40}\ntracking: {esm: {levels: 1}}\n";
  EXPECT_EQ(run(images_.path() + " --params " + out_.file("roi.yaml")), kSuccess) << stderr_;
}

TEST_F(TrackBag, ListsEveryErrorOfTheParameters) {
  std::ofstream(out_.file("bad.yaml")) << "tracking: {esm: {levels: 99, min_step: slow}, qualty: {min_zncc: 1}}\n";
  EXPECT_EQ(run(images_.path() + " --roi 50,40,50,40 --params " + out_.file("bad.yaml")), kFailure);
  EXPECT_TRUE(says("3 errors")) << stderr_;
  EXPECT_TRUE(says("levels") && says("99") && says("min_step") && says("slow") && says("qualty")) << stderr_;
  EXPECT_TRUE(says("bad.yaml")) << stderr_;
  std::ofstream(out_.file("broken.yaml")) << "tracking: {esm: [\n";
  EXPECT_EQ(run(images_.path() + " --roi 50,40,50,40 --params " + out_.file("broken.yaml")), kFailure);
  EXPECT_TRUE(says("broken.yaml") && says("line")) << stderr_;
  EXPECT_EQ(run(images_.path() + " --roi 50,40,50,40 --params " + out_.file("missing.yaml")), kFailure);
  EXPECT_TRUE(says("missing.yaml")) << stderr_;
}

TEST_F(TrackBag, SaysWhatIsWrongWithTheCommandLine) {
  EXPECT_EQ(run(images_.path() + " --roi 50,40,50,40 --nonsense"), kBadUsage);
  EXPECT_TRUE(says("--nonsense") || says("nonsense")) << stderr_;
  EXPECT_EQ(run(images_.path() + " --roi 50,40,50,40 --start soon"), kBadUsage);
  EXPECT_EQ(run("--roi 50,40,50,40"), kFailure);
  EXPECT_TRUE(says("no input")) << stderr_;
  EXPECT_EQ(run(images_.path()), kFailure);
  EXPECT_TRUE(says("--roi")) << stderr_;
  EXPECT_EQ(run(images_.path() + " --roi 50,40,50"), kFailure);
  EXPECT_TRUE(says("50,40,50")) << stderr_;
  EXPECT_EQ(run(images_.path() + " --roi 50,40,500,40"), kFailure);
  EXPECT_TRUE(says("500") && says("160 x 120")) << stderr_;
  EXPECT_EQ(run(out_.file("missing.bag") + " --roi 50,40,50,40"), kFailure);
  EXPECT_TRUE(says("missing.bag")) << stderr_;
  EXPECT_EQ(run("--help"), kSuccess);
  EXPECT_NE(stdout_.find("--image-topic"), std::string::npos);
}

TEST_F(TrackBag, EndsWithOneWhenAnImageCouldNotBeProcessed) {
  std::ofstream(images_.file("2.png")) << "broken";
  EXPECT_EQ(run(images_.path() + " --roi 50,40,50,40 --csv " + out_.file("out.csv")), kFailure);
  EXPECT_TRUE(says("2.png")) << stderr_;
  EXPECT_TRUE(says("1 of 4 images")) << stderr_;
  const std::string table = content(out_.file("out.csv"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4) << "the others are in the table";
}

TEST_F(TrackBag, TracksFeaturesOfAFile) {
  const test_support::TemporaryFolder scene;
  for (unsigned k = 0; k < 3; ++k)
    cv::imwrite(scene.file(std::to_string(k) + ".png"), test_support::featureScene(0.5 * k, k + 1));
  const std::string file = out_.file("features.yaml"), table = out_.file("out.csv");
  for (const std::string tracker : {"dots", "points", "edges"}) {
    std::ofstream(file) << (tracker == "dots"     ? test_support::kDotsSelection
                            : tracker == "points" ? test_support::kPointsSelection
                                                  : test_support::kEdgesSelection);
    const std::string command = scene.path() + " --tracker " + tracker + " --select " + file;
    EXPECT_EQ(run(command + " --csv " + table), kSuccess) << stderr_;
    EXPECT_TRUE(says("3 images: TRACKING 3")) << stderr_;
    const std::string rows = content(table);
    EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1 + 3 * 2);
    EXPECT_EQ(rows.substr(0, rows.find('\n')),
              "frame,stamp,state,processing_time,id,kind,feature_state,share,expected_error,parameters,deviations"
              ",outline,reason");
  }
  std::ofstream(file) << "- {id: short, line: [[50, 50], [52, 50]]}\n";
  EXPECT_EQ(run(scene.path() + " --tracker=edges --select " + file), kFailure);
  EXPECT_TRUE(says("short: line from (50, 50) to (52, 50), expected finite ends at least 30 px apart")) << stderr_;
  EXPECT_EQ(run(scene.path() + " --tracker edges"), kFailure);
  EXPECT_TRUE(says("no selection is given, expected --select FILE.yaml")) << stderr_;
  EXPECT_EQ(run(scene.path() + " --tracker circles --select " + file), kFailure);
  EXPECT_TRUE(says("tracker 'circles', expected one of")) << stderr_;
  EXPECT_EQ(run(images_.path() + " --tracker region --roi 50,40,50,40"), kSuccess) << stderr_;
}

}  // namespace
}  // namespace laparoscope_servo
