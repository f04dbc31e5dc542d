// track_bag --select as a user runs it: a window, a mouse, keys.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "support/command_output.h"
#include "support/synthetic_sequence.h"
#include "support/temporary_folder.h"
#include "system/screen/virtual_display.h"

namespace laparoscope_servo {
namespace {

using test_support::hands;

class SelectRegion : public testing::Test {
 protected:
  SelectRegion() {
    const geometry::Rectangle roi{50.0, 40.0, 50.0, 40.0};
    int k = 0;
    for (const Eigen::Matrix3d& g : test_support::motion(3, roi, 2.0)) {
      const cv::Mat picture = test_support::view(test_support::texture(cv::Size(320, 200)), g);
      cv::imwrite(images_.file(std::to_string(k++) + ".png"), picture);
    }
  }
  test_support::CommandOutput run(const std::string& arguments, const std::string& environment = "") const {
    return test_support::outputOf("ROS_MASTER_URI=http://localhost:1 " + environment + " " TRACK_BAG " " +
                                  images_.path() + " " + arguments);
  }
  // The window fills the middle of its display; a picture of 320x200 px is in its middle.
  static void waitForWindow() {
    const int found =
        std::system("timeout 60 xdotool search --sync --onlyvisible --name 'Region in image 0' windowfocus --sync");
    ASSERT_EQ(found, 0) << "no window";
  }

  test_support::TemporaryFolder images_;
};

TEST_F(SelectRegion, WhatIsDrawnIsTracked) {
  const test_support::VirtualDisplay display;
  const std::string csv = images_.file("out.csv");
  auto tracked = std::async(std::launch::async, [&] { return run("--select --csv " + csv); });
  waitForWindow();
  hands("mousemove 500 300 mousedown 1 mousemove 600 330 mousemove 800 500 mouseup 1 key Right key Return");
  const test_support::CommandOutput output = tracked.get();
  EXPECT_EQ(output.status, 0) << output.text;
  int x = 0, y = 0, width = 0, height = 0;
  const std::size_t at = output.text.find("--roi ");
  ASSERT_NE(at, std::string::npos) << output.text;
  ASSERT_EQ(std::sscanf(output.text.c_str() + at, "--roi %d,%d,%d,%d", &x, &y, &width, &height), 4) << output.text;
  // The picture is drawn 3.6 to 4 times as large, as the words below it leave room.
  EXPECT_NEAR(300.0 / width, 3.8, 0.25);
  EXPECT_NEAR(200.0 / height, 3.8, 0.25);
  EXPECT_NE(output.text.find("3 images:"), std::string::npos) << output.text;
  EXPECT_TRUE(std::filesystem::exists(csv));
}

TEST_F(SelectRegion, EscapeEndsWithoutATrack) {
  const test_support::VirtualDisplay display;
  auto tracked = std::async(std::launch::async, [&] { return run("--select --csv " + images_.file("out.csv")); });
  waitForWindow();
  hands("key Escape");
  const test_support::CommandOutput output = tracked.get();
  EXPECT_EQ(output.status, 1);
  EXPECT_NE(output.text.find("no region was selected"), std::string::npos) << output.text;
  EXPECT_FALSE(std::filesystem::exists(images_.file("out.csv")));
}

TEST_F(SelectRegion, WithoutADisplayItSaysWhatElseThereIs) {
  const auto nothing = run("--select", "DISPLAY= QT_QPA_PLATFORM= WAYLAND_DISPLAY=");
  EXPECT_EQ(nothing.status, 1);
  EXPECT_NE(nothing.text.find("no display"), std::string::npos) << nothing.text;
  EXPECT_NE(nothing.text.find("--roi"), std::string::npos) << nothing.text;
  const auto dead = run("--select", "DISPLAY=:987 QT_QPA_PLATFORM=xcb");
  EXPECT_EQ(dead.status, 1) << dead.text;
  EXPECT_NE(dead.text.find("--select gave no region"), std::string::npos) << dead.text;
  const auto both = run("--select --roi 1,2,30,40");
  EXPECT_EQ(both.status, 1);
  EXPECT_NE(both.text.find("expected one of them"), std::string::npos) << both.text;
  const auto none = run("--select --start 100", "DISPLAY=:987");
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.text.find("has no image after 100"), std::string::npos) << none.text;
}

}  // namespace
}  // namespace laparoscope_servo
