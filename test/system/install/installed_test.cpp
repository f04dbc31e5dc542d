// Installed into an empty folder, the package needs neither its sources nor its build.
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "support/synthetic_sequence.h"
#include "system/aesop/child_process.h"
#include "system/install/installed_prefix.h"
#include "system/network/open_sockets.h"

namespace laparoscope_servo::test {
namespace {

int freePort() {
  const int file = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(name);
  ::bind(file, reinterpret_cast<const sockaddr*>(&name), size);
  ::getsockname(file, reinterpret_cast<sockaddr*>(&name), &size);
  ::close(file);
  return ntohs(name.sin_port);
}

// The first of the places that nothing installed may know, in this text; empty when there is none.
std::string foreignPlaceIn(const std::string& text) {
  const std::string rest = replaced(text, CONFIGURED_PREFIX, "");  // of an install space inside the workspace
  for (const char* place : {PACKAGE, SOURCES, BUILD, DEVEL}) {
    if (rest.find(place) != std::string::npos) return place;
  }
  return "";
}

class Installed : public testing::Test {
 protected:
  static void SetUpTestSuite() { prefix = std::make_unique<InstalledPrefix>(); }
  static void TearDownTestSuite() { prefix.reset(); }

  // `launch` under a master of its own; ends with the test.
  void start(const std::string& launch) {
    port_ = freePort();
    launch_ = std::make_unique<ChildProcess>("/usr/bin/env", prefix->shell("exec roslaunch " + launch, port_), log());
  }
  void TearDown() override {
    if (!launch_) return;
    launch_->kill(SIGINT);
    launch_->exitStatus(30.0);
  }
  static std::string log() { return prefix->scratch("log"); }
  std::string lastLines() const {
    const std::string text = contentOf(log());
    return text.substr(std::max<std::size_t>(text.size(), 3000) - 3000);
  }
  // What the launch has started has loaded nothing of the sources or the build; how many have this file of the prefix.
  int processesWith(const std::string& file) const {
    int count = 0;
    for (const pid_t pid : processTree(launch_->pid())) {
      const std::string maps = contentOf("/proc/" + std::to_string(pid) + "/maps");
      EXPECT_EQ(foreignPlaceIn(maps), "") << maps;
      if (maps.find(prefix->path() + "/" + file) != std::string::npos) ++count;
    }
    return count;
  }

  static std::unique_ptr<InstalledPrefix> prefix;
  std::unique_ptr<ChildProcess> launch_;
  int port_ = 0;
};
std::unique_ptr<InstalledPrefix> Installed::prefix;

TEST_F(Installed, noFileNamesTheSourcesOrTheBuild) {
  int files = 0, links = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(prefix->path())) {
    if (entry.is_symlink()) {
      ++links;
      EXPECT_TRUE(std::filesystem::read_symlink(entry.path()).is_relative()) << entry.path();
      EXPECT_TRUE(std::filesystem::exists(entry.path())) << entry.path() << " leads nowhere";
    }
    if (!entry.is_regular_file()) continue;
    ++files;
    const std::string content = contentOf(entry.path());
    EXPECT_EQ(foreignPlaceIn(content), "") << "in " << entry.path();
    if (content.rfind("\x7f"
                      "ELF",
                      0) != 0)
      continue;
    const auto dynamic = test_support::outputOf("readelf -d '" + entry.path().string() + "'");
    EXPECT_EQ(dynamic.status, 0) << dynamic.text;
    EXPECT_NE(dynamic.text.find("(NEEDED)"), std::string::npos) << dynamic.text;
    EXPECT_EQ(foreignPlaceIn(dynamic.text), "") << "in " << entry.path();
  }
  EXPECT_GT(files, 100);
  EXPECT_EQ(links, 0);
}

TEST_F(Installed, whatBelongsToThePackageIsThere) {
  const std::string share = prefix->path() + "/share/laparoscope_servo/";
  for (const char* file :
       {"package.xml", "nodelet_plugins.xml", "rviz_plugins.xml", "README.md", "config/aesop.yaml",
        "config/scenarios/paper.yaml", "doc/network.md", "launch/demo.launch", "linux/laparoscope-servo-cart.service",
        "loopback/roscore.xml", "rviz/cart.rviz", "rviz/screen.rviz", "msg/TaskError.msg", "srv/SelectRoi.srv",
        "cmake/laparoscope_servoConfig.cmake"}) {
    EXPECT_TRUE(std::filesystem::is_regular_file(share + file)) << file;
  }
  EXPECT_TRUE(std::filesystem::exists(prefix->path() + "/include/laparoscope_servo/tracking/region_tracker.h"));
  EXPECT_TRUE(std::filesystem::exists(prefix->path() + "/include/laparoscope_servo/TaskError.h"));
}

TEST_F(Installed, theEnvironmentIsOfThePrefixAndTheSystem) {
  const auto environment = prefix->run("env", 11311);
  ASSERT_EQ(environment.status, 0) << environment.text;
  EXPECT_EQ(foreignPlaceIn(environment.text), "") << environment.text;
  for (const std::string& variable :
       {"CMAKE_PREFIX_PATH=" + prefix->path(), "LD_LIBRARY_PATH=" + prefix->path() + "/lib",
        "ROS_PACKAGE_PATH=" + prefix->path() + "/share"}) {
    EXPECT_NE(environment.text.find("\n" + variable), std::string::npos) << variable << " in " << environment.text;
  }
  EXPECT_EQ(environment.text.find("LD_PRELOAD"), std::string::npos) << environment.text;
  EXPECT_NE(environment.text.find("ROS_IP=127.0.0.1\n"), std::string::npos) << environment.text;
  EXPECT_EQ(prefix->run("rospack find laparoscope_servo", 11311).text, prefix->path() + "/share/laparoscope_servo\n");
  EXPECT_EQ(prefix->run("rosrun --prefix echo laparoscope_servo tracker </dev/null", 11311).text,
            prefix->path() + "/lib/laparoscope_servo/tracker\n");
}

TEST_F(Installed, trackBagTracksAVideo) {
  const std::string video = prefix->scratch("video.avi");
  const cv::Mat texture = test_support::texture(cv::Size(160, 120));
  {
    cv::VideoWriter writer(video, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25.0, texture.size());
    ASSERT_TRUE(writer.isOpened());
    for (const Eigen::Matrix3d& g : test_support::motion(8, geometry::Rectangle{50.0, 40.0, 50.0, 40.0}, 3.0)) {
      cv::Mat image = test_support::view(texture, g);
      if (image.channels() == 1) cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
      writer.write(image);
    }
  }
  const std::string table = prefix->scratch("table.csv");
  const auto run =
      prefix->run("rosrun laparoscope_servo track_bag '" + video + "' --roi 50,40,50,40 --csv '" + table + "'", 1);
  EXPECT_EQ(run.status, 0) << run.text;
  EXPECT_NE(run.text.find("8 images: TRACKING"), std::string::npos) << run.text;
  const std::string rows = contentOf(table);
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 9) << rows;
}

TEST_F(Installed, theReportOfASessionIsMade) {
  const std::string table = prefix->scratch("session.csv"), page = prefix->scratch("session.html");
  std::ofstream(table) << "frame,stamp,state,visible_fraction,processing_time,corner_error,reason\n"
                          "0,0.00,1,0.9,0.004,0.3,\n1,0.04,1,0.9,0.004,0.3,\n";
  const auto run = prefix->run("rosrun laparoscope_servo session_report '" + table + "' '" + page + "'", 1);
  EXPECT_EQ(run.status, 0) << run.text;
  EXPECT_NE(contentOf(page).find("2 results of the tracker"), std::string::npos) << run.text;
}

TEST_F(Installed, aManagerLoadsTheNodelet) {
  const std::string file = prefix->scratch("manager.launch");
  std::ofstream(file) << R"(<launch>
  <node pkg="nodelet" type="nodelet" name="manager" args="manager"/>
  <include file="$(find laparoscope_servo)/launch/tracker.launch"><arg name="manager" value="manager"/></include>
</launch>)";
  start(file);
  const auto found = prefix->run(
      "timeout 120 bash -c 'until rosservice list 2>/dev/null | grep -x /tracker/select_roi; do sleep 0.2; done'",
      port_);
  ASSERT_EQ(found.status, 0) << found.text << lastLines();
  EXPECT_EQ(processesWith("lib/liblaparoscope_servo_nodelets.so"), 1) << "the manager";
  EXPECT_EQ(processesWith("lib/liblaparoscope_servo_loopback.so"), 2) << "rosout, and what loads the nodelet";
}

TEST_F(Installed, theDemoConverges) {
  start("laparoscope_servo demo.launch rviz:=false port:='" + prefix->scratch("arm") + "' control:='" +
        prefix->scratch("control") + "'");
  const std::string summary = prefix->scratch("summary.json");
  const auto director = prefix->run(
      "timeout 240 bash -c 'until rosparam get /run_id >/dev/null 2>&1; do sleep 0.2; done' && "
      "timeout 240 rosrun laparoscope_servo demo_director _cross_instrument:=false _control:='" +
          prefix->scratch("control") + "' _summary:='" + summary + "'",
      port_);
  EXPECT_EQ(director.status, 0) << director.text << lastLines();
  EXPECT_NE(contentOf(summary).find("\"converged\": true"), std::string::npos) << contentOf(summary);
  // Emulator, camera, tracker, controller and the robot's node.
  EXPECT_EQ(processesWith("lib/liblaparoscope_servo_core.so"), 5) << lastLines();
}

}  // namespace
}  // namespace laparoscope_servo::test
