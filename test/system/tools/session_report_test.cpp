// scripts/session_report as a user runs it, on bags and tables that the test makes.
#include <gtest/gtest.h>
#include <laparoscope_servo/ControllerState.h>
#include <laparoscope_servo/Homography.h>
#include <laparoscope_servo/ScopeVelocity.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CompressedImage.h>
#include <std_msgs/Empty.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>

#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

class SessionReport : public testing::Test {
 protected:
  int report(const std::string& inputs, const std::string& options = "") {
    const std::string command = std::string(SESSION_REPORT) + " " + inputs + " '" + folder_.file("report.html") + "' " +
                                options + " >'" + folder_.file("log") + "' 2>&1";
    const int status = std::system(command.c_str());
    html_ = contents("report.html");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string contents(const std::string& name) const {
    std::ifstream stream(folder_.file(name));
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  bool has(const std::string& text) const { return html_.find(text) != std::string::npos; }
  // Nothing is fetched, and nothing that was recorded becomes markup.
  void expectClosed() const {
    EXPECT_FALSE(has("<script") || has("<iframe") || has("<link") || has("@import") || has("<!DOCTYPE svg"));
    for (const auto& [attribute, allowed] :
         {std::pair<std::string, std::string>{"href=\"", "#"}, {"src=\"", "data:image/jpeg"}, {"url(", "#"}}) {
      for (std::size_t at = html_.find(attribute); at != std::string::npos; at = html_.find(attribute, at + 1)) {
        EXPECT_EQ(html_.compare(at + attribute.size(), allowed.size(), allowed), 0) << html_.substr(at, 60);
      }
    }
  }
  static ros::Time at(int k) { return ros::Time(1500000000.0 + 0.04 * k); }
  // What was computed again from that case: the first 10 images are left out, the next 10 lost, the others `apart` px
  // off at one corner.
  std::string recomputed(double apart) {
    const std::string file = folder_.file("again.bag");
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    for (int k = 10; k < 200; ++k) {
      Homography result;
      result.header.stamp = at(k);
      result.state = k < 20 ? Homography::LOST : Homography::TRACKING;
      result.corners = {10, 10, 30, 10, 30 + 0.6 * apart, 30 - 0.8 * apart, 10, 30};
      bag.write("/tracker/homography", at(k), result);
    }
    return file;
  }
  // 200 results: covered from 50 to 74, lost from 100 to 124; the controller holds then, and somebody stops in the end.
  std::string bag(bool pictures, const std::string& reason = "the region is lost") {
    const std::string file = folder_.file("case.bag");
    rosbag::Bag bag(file, rosbag::bagmode::Write);
    bag.setChunkThreshold(20000);
    sensor_msgs::CompressedImage image;
    image.format = "bgr8; jpeg compressed bgr8";
    cv::imencode(".jpg", cv::Mat(48, 64, CV_8UC3, cv::Scalar(40, 60, 120)), image.data);
    ControllerState state;
    state.state = "SERVO";
    for (int k = 0; k < 200; ++k) {
      const ros::Time recorded = at(k) + ros::Duration(0.02);
      image.header.stamp = at(k);
      if (pictures) bag.write("/camera/image_raw/compressed", at(k) + ros::Duration(0.01), image);
      Homography result;
      result.header.stamp = at(k);
      result.reference_stamp = at(0);
      const bool lost = k >= 100 && k < 125;
      result.state = lost ? Homography::SEARCHING : Homography::TRACKING;
      result.visible_fraction = k >= 50 && k < 75 ? 0.4 : 0.95;
      result.corners = {10, 10, 30, 10, 30, 30, 10, 30};
      result.processing_time = 0.005;
      bag.write("/tracker/homography", recorded, result);
      ScopeVelocity command;
      command.pan = 0.05;
      bag.write("/servo_command", recorded, command);
      const std::string wanted = lost ? "HOLD" : "SERVO";
      if (state.state != wanted || k == 0) {
        state.state = wanted;
        state.reason = lost ? reason : "nothing is missing";
        bag.write("/controller/state", recorded, state);
      }
    }
    bag.write("/aesop/stop", at(200), std_msgs::Empty());
    return file;
  }

  test_support::TemporaryFolder folder_;
  std::string html_;
};

TEST_F(SessionReport, TellsWhatHappened) {
  ASSERT_EQ(report("'" + bag(true) + "'"), 0) << contents("log");
  EXPECT_TRUE(has("200 results of the tracker and 200 pictures"));
  EXPECT_TRUE(has("about 20 x 20 px at (10, 10)"));
  EXPECT_TRUE(has("at least 40 % of the region stayed visible"));
  EXPECT_TRUE(has("found again"));
  EXPECT_TRUE(has("SERVO → HOLD") && has("the region is lost"));
  EXPECT_TRUE(has("stop on /aesop/stop"));
  EXPECT_TRUE(has("pan 0.050"));
  EXPECT_TRUE(has("<td>20.0 ms</td>")) << "image to result";
  EXPECT_TRUE(has("<svg") && has("data:image/jpeg;base64,"));
  expectClosed();
}

TEST_F(SessionReport, TellsHowFarRecomputedResultsAreFromRecordedOnes) {
  const std::string again = recomputed(0.5);
  ASSERT_EQ(report("'" + bag(false) + "'", "--recomputed '" + again + "'"), 0) << contents("log");
  EXPECT_TRUE(
      has("Of 190 images there are results of both: 155 were tracked by both, 10 when it\nwas recorded only, 25 "
          "when it was computed again only."));
  EXPECT_TRUE(has("<td>0.50 px</td><td>0.50 px</td><td>0.50 px</td><td>0.50 px</td>"));
  expectClosed();
  ASSERT_EQ(report("'" + bag(false) + "'"), 0) << contents("log");
  EXPECT_FALSE(has("recomputed"));
  EXPECT_EQ(report("'" + bag(false) + "'", "--recomputed '" + folder_.file("nothing.bag") + "'"), 1);
}

// A bag of two carts on one master. Their states and commands must not become those of one.
TEST_F(SessionReport, OfTwoCartsItTellsOfTheOneThatIsChosen) {
  const std::string file = folder_.file("two.bag");
  rosbag::Bag bag(file, rosbag::bagmode::Write);
  for (int k = 0; k < 100; ++k) {
    for (const std::string cart : {"/left", "/right"}) {
      Homography result;
      result.header.stamp = at(k);
      result.state = cart == "/left" ? Homography::TRACKING : Homography::LOST;
      bag.write(cart + "/tracker/homography", at(k), result);
      ControllerState state;
      state.state = cart == "/left" ? "SERVO" : "LOST";
      bag.write(cart + "/controller/state", at(k), state);
    }
  }
  bag.close();
  ASSERT_EQ(report("'" + file + "'"), 1);
  EXPECT_NE(contents("log").find("/left/tracker/homography and /right/tracker/homography"), std::string::npos)
      << contents("log");
  EXPECT_NE(contents("log").find("--cart"), std::string::npos) << contents("log");
  EXPECT_FALSE(std::filesystem::exists(folder_.file("report.html")));
  ASSERT_EQ(report("'" + file + "'", "--cart /right"), 0) << contents("log");
  EXPECT_TRUE(has("100 results of the tracker"));
  EXPECT_TRUE(has("begins as LOST"));
  EXPECT_FALSE(has("SERVO"));
  ASSERT_EQ(report("'" + file + "'", "--cart left"), 0) << contents("log");
  EXPECT_TRUE(has("begins as SERVO"));
  ASSERT_EQ(report("'" + file + "'", "--cart /middle"), 0);
  EXPECT_TRUE(has("There is nothing in it"));
  EXPECT_NE(contents("log").find("no topic begins with /middle/"), std::string::npos) << contents("log");
}

TEST_F(SessionReport, WithoutPicturesItTellsTheRest) {
  ASSERT_EQ(report("'" + bag(false) + "'"), 0) << contents("log");
  EXPECT_TRUE(has("no picture") && has("found again"));
  EXPECT_FALSE(has("data:image"));
  expectClosed();
}

TEST_F(SessionReport, NamesWithMarkupStayText) {
  const std::string name = "<script>alert(1)</script>&amp;\"'";
  ASSERT_EQ(report("'" + bag(true, name) + "'", "--title '<img src=x onerror=alert(2)>'"), 0) << contents("log");
  EXPECT_TRUE(has("&lt;script&gt;alert(1)"));
  EXPECT_TRUE(has("&lt;img src=x"));
  expectClosed();
}

TEST_F(SessionReport, ABagThatWasCutOffIsToldUpToThere) {
  const std::string file = bag(true);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  ASSERT_EQ(report("'" + file + "'"), 0) << contents("log");
  EXPECT_TRUE(has("breaks off")) << html_.substr(0, 2000);
  EXPECT_TRUE(has("at least 40 %"));
  EXPECT_FALSE(has("stop on /aesop/stop"));
  expectClosed();
}

TEST_F(SessionReport, AnEmptyBagAndAnEmptyFileHaveNothingInThem) {
  rosbag::Bag(folder_.file("empty.bag"), rosbag::bagmode::Write).close();
  ASSERT_EQ(report("'" + folder_.file("empty.bag") + "'"), 0) << contents("log");
  EXPECT_TRUE(has("There is nothing in it"));
  std::ofstream(folder_.file("none.bag")).close();
  ASSERT_EQ(report("'" + folder_.file("none.bag") + "'"), 1) << contents("log");
  EXPECT_TRUE(has("is no bag of format 2.0"));
}

TEST_F(SessionReport, ReadsATableOfTrackBag) {
  std::ofstream table(folder_.file("a.csv"));
  table << "frame,stamp,state,visible_fraction,processing_time,corner_error,reason\n";
  for (int k = 0; k < 100; ++k) {
    const bool lost = k >= 40 && k < 60;
    table << k << ',' << 0.04 * k << ',' << (lost ? 2 : 1) << ",0.9,0.004," << (lost ? "inf" : "0.3") << ",\""
          << (lost ? "it <b>left</b> the picture" : "") << "\"\n";
  }
  table.close();
  ASSERT_EQ(report("'" + folder_.file("a.csv") + "'"), 0) << contents("log");
  EXPECT_TRUE(has("100 results of the tracker"));
  EXPECT_TRUE(has("it &lt;b&gt;left&lt;/b&gt; the picture"));
  EXPECT_TRUE(has("found again"));
  expectClosed();
}

TEST_F(SessionReport, SaysWhatIsWrong) {
  EXPECT_EQ(report("'" + folder_.file("nothing.bag") + "'"), 1);
  EXPECT_NE(contents("log").find("nothing.bag"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_.file("report.html")));
  EXPECT_EQ(report("", ""), 2);
}

}  // namespace
}  // namespace laparoscope_servo
