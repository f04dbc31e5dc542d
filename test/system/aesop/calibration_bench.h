// The aesop node against an emulator whose trocar is 10 mm from where the node believes it to be.
#pragma once

#include <laparoscope_servo/CalibrationState.h>
#include <laparoscope_servo/StartCalibration.h>

#include <fstream>

#include "laparoscope_servo/aesop/driver.h"
#include "support/temporary_folder.h"
#include "system/aesop/aesop_bench.h"

namespace laparoscope_servo::test {

inline Eigen::Vector3d believedTrocar() {
  return aesop::DriverConfig().insertion_point;
}

class CalibrationBench {
 public:
  CalibrationBench() : bench(false, {"--params", emulatorFile()}) {
    subscriber_ =
        node_.subscribe<CalibrationState>("aesop/calibrate_insertion_point/state", 10,
                                          [this](const CalibrationState::ConstPtr& message) { state = *message; });
    startNode();
  }

  void startNode(const std::string& insertion_point_file = "") {
    XmlRpc::XmlRpcValue overlay;
    overlay["calibration"]["file"] = file();
    overlay["calibration"]["pattern_allowed"] = true;
    overlay["calibration"]["pattern_speed"] = 0.15;
    overlay["insertion_point_file"] = insertion_point_file;
    state.reset();
    bench.setParameters(overlay);
    bench.startNode();
  }
  void restartNode(const std::string& insertion_point_file) {
    bench.node().kill(SIGTERM);
    EXPECT_EQ(bench.node().exitStatus(5.0), 0);
    startNode(insertion_point_file);
  }

  StartCalibration::Response start(const std::string& method) {
    StartCalibration call;
    call.request.method = method;
    if (!ros::service::call("aesop/calibrate_insertion_point/start", call))
      throw std::runtime_error("no service start");
    return call.response;
  }
  std_srvs::Trigger::Response finish() { return bench.call("calibrate_insertion_point/finish"); }
  std_srvs::Trigger::Response cancel() { return bench.call("calibrate_insertion_point/cancel"); }
  bool waitForState(const std::string& name, double seconds = 20.0) {
    return bench.waitFor([&] { return state && state->state == name; }, seconds);
  }

  // A hand moves the scope about the true trocar; waits until it rests.
  void hand(double pan, double tilt, double seconds = 0.5) {
    bench.truth().hand({pan, tilt, 0.0, 0.0}, seconds);
    EXPECT_TRUE(bench.waitFor([&] { return !bench.truth().motion().moving; }));
  }
  void swing(double size) {
    hand(size, 0.0);
    hand(-2.0 * size, 0.0);
    hand(size, size);
    hand(0.0, -2.0 * size);
    hand(0.0, size);
  }

  // The pattern, on its way.
  bool startPattern() {
    return bench.enable() && start(StartCalibration::Request::PATTERN).success &&
           bench.waitFor([&] { return state && state->poses > 10 && bench.jointsMove(); });
  }

  std::string file() const { return folder_.file("point.yaml"); }
  Eigen::Vector3d trueTrocar() const { return believedTrocar() + Eigen::Vector3d(0.006, -0.006, 0.0055); }

 private:
  std::string emulatorFile() const {
    const Eigen::Vector3d p = trueTrocar();
    std::ofstream(folder_.file("emulator.yaml"))
        << "emulator:\n  insertion_point: [" << p.x() << ", " << p.y() << ", " << p.z() << "]\n";
    return folder_.file("emulator.yaml");
  }

  const test_support::TemporaryFolder folder_;
  ros::NodeHandle node_;
  ros::Subscriber subscriber_;

 public:
  AesopBench bench;
  std::optional<CalibrationState> state;
};

}  // namespace laparoscope_servo::test
