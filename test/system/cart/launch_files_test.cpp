// What launch files promise; that they can be run is checked by roslaunch's own check.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

namespace {

std::string outputOf(const std::string& command) {
  std::string output;
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return "cannot run " + command;
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) output += buffer.data();
  const int status = ::pclose(pipe);
  return status == 0 ? output : output + command + " ended with " + std::to_string(status);
}

std::set<std::string> nodesOf(const std::string& launch) {
  std::istringstream stream(outputOf("roslaunch --nodes laparoscope_servo " + launch));
  std::set<std::string> nodes;
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty()) nodes.insert(line);
  }
  return nodes;
}

using Nodes = std::set<std::string>;

TEST(LaunchFiles, ReplayStartsNoNodeOfTheRobot) {
  EXPECT_EQ(nodesOf("replay.launch bag:=x.bag"), (Nodes{"/player", "/tracker", "/rviz"}));
  EXPECT_EQ(nodesOf("replay.launch video:=x.mp4 rviz:=false"), (Nodes{"/player", "/tracker"}));
  EXPECT_EQ(nodesOf("replay.launch video:=x.mp4 screen:=window"),
            (Nodes{"/player", "/tracker", "/laparoscope_screen"}));
}

TEST(LaunchFiles, CartAndDemoStartWhatTheySay) {
  const Nodes cart{"/tracker", "/controller", "/aesop"};
  Nodes demo = cart;
  demo.insert({"/aesop_emulator", "/simulated_camera"});
  EXPECT_EQ(nodesOf("cart.launch port:=/dev/ttyX rviz:=false"), cart);
  EXPECT_EQ(nodesOf("demo.launch rviz:=false"), demo);
  Nodes with_screen = cart;
  with_screen.insert("/laparoscope_screen");
  EXPECT_EQ(nodesOf("cart.launch port:=/dev/ttyX screen:=window"), with_screen);
  Nodes with_panel = cart;
  with_panel.insert({"/rviz", "/scope_markers"});
  EXPECT_EQ(nodesOf("cart.launch port:=/dev/ttyX rviz:=false screen:=rviz"), with_panel);
  EXPECT_EQ(nodesOf("cart.launch port:=/dev/ttyX screen:=none"), cart);
  EXPECT_EQ(nodesOf("cart.launch port:=/dev/ttyX"), with_panel) << "rviz as ever";
  EXPECT_NE(outputOf("roslaunch --nodes laparoscope_servo cart.launch port:=/dev/ttyX screen:=tv").find("tv"),
            std::string::npos);
  EXPECT_EQ(nodesOf("calibrate.launch port:=/dev/ttyX file:=/x.yaml"), Nodes{"/aesop"});
  Nodes with_instruments = cart;
  with_instruments.insert("/instrument");
  EXPECT_EQ(nodesOf("cart.launch port:=/dev/ttyX screen:=none instruments:=true"), with_instruments);
  EXPECT_EQ(nodesOf("cart.launch port:=/dev/ttyX screen:=none instruments:=false"), cart);
  EXPECT_EQ(nodesOf("tracker.launch instruments:=true manager:=m"), (Nodes{"/tracker", "/instrument"}));
  EXPECT_EQ(nodesOf("tracker.launch"), Nodes{"/tracker"});
  EXPECT_EQ(nodesOf("joystick.launch"), Nodes{"/joystick"});
  EXPECT_EQ(nodesOf("joystick.launch name:=pedal device:=/dev/input/js1"), Nodes{"/pedal"});
  EXPECT_EQ(nodesOf("record.launch folder:=/tmp/case"), Nodes{"/recorder"});
  EXPECT_EQ(nodesOf("camera.launch device:=/dev/video0"), Nodes{"/camera_driver"});
  EXPECT_EQ(nodesOf("camera.launch manager:=camera_manager"), (Nodes{"/camera_driver", "/camera_manager"}));
  EXPECT_EQ(nodesOf("tracker.launch manager:=camera_manager"), Nodes{"/tracker"});
}

std::string parametersOf(const std::string& launch) {
  return outputOf("roslaunch --dump-params laparoscope_servo " + launch);
}

// A node's working directory is not that of the shell.
TEST(LaunchFiles, RelativePathsAreThoseOfTheShell) {
  const auto from = [](const std::string& launch) {
    return outputOf("cd /usr/share && roslaunch --dump-params laparoscope_servo " + launch);
  };
  const auto expect = [](const std::string& output, const std::string& line) {
    EXPECT_NE(output.find(line + "\n"), std::string::npos) << line << ", but:\n" << output;
  };
  expect(from("record.launch folder:=cases"), "/recorder/folder: /usr/share/cases");
  expect(from("record.launch folder:=/tmp/cases"), "/recorder/folder: /tmp/cases");
  expect(from("calibrate.launch port:=/dev/ttyX file:=x.yaml"), "/aesop/calibration/file: /usr/share/x.yaml");
  const std::string cart = from("cart.launch port:=/dev/ttyX rviz:=false insertion_point_file:=x.yaml");
  expect(cart, "/aesop/insertion_point_file: /usr/share/x.yaml");
  expect(cart, "/aesop/calibration/file: /usr/share/x.yaml");
  expect(from("features.launch selection:=x.yaml"), "/edges/selection: /usr/share/x.yaml");
  const std::string camera = from("camera.launch device:=film.mp4 calibration:=c.ini");
  expect(camera, "/camera_driver/device: /usr/share/film.mp4");
  expect(camera, "/camera_driver/calibration: /usr/share/c.ini");
  expect(from("camera.launch"), "/camera_driver/calibration: ''");
  expect(from("camera.launch device:=rtsp://10.0.0.1/x"), "/camera_driver/device: rtsp://10.0.0.1/x");
  expect(from("replay.launch video:=film.mp4"), "/player/folder: /usr/share");
}

TEST(LaunchFiles, ControllerOfACartAsksForTheRobotAndForADeadManThatIsGiven) {
  const std::string cart = parametersOf("cart.launch port:=/dev/ttyX rviz:=false");
  EXPECT_NE(cart.find("/controller/safety/robot_required: true"), std::string::npos) << cart;
  EXPECT_NE(cart.find("/controller/safety/dead_man_required: false"), std::string::npos) << cart;
  const std::string demo = parametersOf("demo.launch rviz:=false dead_man:=/pedal");
  EXPECT_NE(demo.find("/controller/safety/robot_required: true"), std::string::npos) << demo;
  EXPECT_NE(demo.find("/controller/safety/dead_man_required: true"), std::string::npos) << demo;
}

// A nodelet publishes under its manager's name.
TEST(LaunchFiles, TheControllerListensToTheTrackerWhereverItRuns) {
  const std::string cart = parametersOf("cart.launch port:=/dev/ttyX rviz:=false");
  EXPECT_NE(cart.find("/controller/owners/task_error: tracker"), std::string::npos) << cart;
  EXPECT_NE(cart.find("/controller/owners/operating_state: aesop"), std::string::npos) << cart;
  const std::string managed = parametersOf("cart.launch port:=/dev/ttyX rviz:=false manager:=camera_manager");
  EXPECT_NE(managed.find("/controller/owners/task_error: camera_manager"), std::string::npos) << managed;
}

TEST(LaunchFiles, CalibrationIsWrittenWhereTheCartReadsIt) {
  const std::string calibrate = parametersOf("calibrate.launch port:=/dev/ttyX file:=/x.yaml");
  EXPECT_NE(calibrate.find("/aesop/calibration/file: /x.yaml"), std::string::npos) << calibrate;
  EXPECT_NE(calibrate.find("/aesop/insertion_point_file: ''"), std::string::npos)
      << "need not be there yet: " << calibrate;
  const std::string cart = parametersOf("cart.launch port:=/dev/ttyX rviz:=false insertion_point_file:=/x.yaml");
  EXPECT_NE(cart.find("/aesop/insertion_point_file: /x.yaml"), std::string::npos) << cart;
  EXPECT_NE(cart.find("/aesop/calibration/file: /x.yaml"), std::string::npos) << cart;
  EXPECT_NE(outputOf("roslaunch --nodes laparoscope_servo calibrate.launch port:=/dev/ttyX").find("file"),
            std::string::npos);
}

TEST(LaunchFiles, CartNeedsItsPort) {
  EXPECT_NE(outputOf("roslaunch --nodes laparoscope_servo cart.launch").find("port"), std::string::npos);
}

// What a run before has set would hold for the next one.
TEST(LaunchFiles, EveryNodeForgetsTheParametersOfTheRunBefore) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(LAPAROSCOPE_SERVO_LAUNCH)) {
    std::ifstream file(entry.path());
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    std::size_t nodes = 0;
    for (std::size_t at = text.find("<node "); at != std::string::npos; at = text.find("<node ", at + 1)) {
      const std::string tag = text.substr(at, text.find('>', at) - at);
      EXPECT_NE(tag.find("clear_params=\"true\""), std::string::npos) << entry.path() << ": " << tag;
      ++nodes;
    }
    EXPECT_GT(nodes, 0u) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 5);
}

// roscpp by itself listens on every address; programs of this package have in them what this library gives to others.
TEST(LaunchFiles, EveryNodeOfAnotherPackageIsKeptToTheLoopbackAddress) {
  int others = 0;
  for (const auto& entry : std::filesystem::directory_iterator(LAPAROSCOPE_SERVO_LAUNCH)) {
    std::ifstream file(entry.path());
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    for (std::size_t at = text.find("<node "); at != std::string::npos; at = text.find("<node ", at + 1)) {
      const std::string tag = text.substr(at, text.find('>', at) - at);
      if (tag.find("pkg=\"laparoscope_servo\"") != std::string::npos) continue;
      const std::string node = text.substr(at, text.find("</node>", at) - at);
      EXPECT_NE(node.find("name=\"LD_PRELOAD\" value=\"liblaparoscope_servo_loopback.so $(optenv LD_PRELOAD)\"/>"),
                std::string::npos)
          << entry.path() << ": " << node;
      ++others;
    }
  }
  EXPECT_EQ(others, 6) << "rviz twice, a manager, and what loads the nodelets of tracker, features and camera";
}

TEST(LaunchFiles, EveryArgumentIsDocumented) {
  for (const char* launch : {"calibrate", "camera", "cart", "demo", "joystick", "record", "replay", "tracker"}) {
    const std::string text = outputOf("roslaunch --ros-args laparoscope_servo " + std::string(launch) + ".launch");
    EXPECT_NE(text.find("YAML file laid over config/"), std::string::npos) << text;
    EXPECT_EQ(text.find("undocumented"), std::string::npos) << text;
  }
}

}  // namespace
