// The tracker nodelet is taken out of its manager while images, selections and changes of parameters come, and put in
// again: the camera's driver may live in that manager.
#include <dynamic_reconfigure/Reconfigure.h>
#include <gtest/gtest.h>
#include <nodelet/loader.h>

#include <atomic>
#include <future>
#include <memory>
#include <thread>

#include "camera_bench.h"
#include "ros/common/name_turn.h"

namespace laparoscope_servo {
namespace {

using test_support::CameraBench;
using test_support::waitFor;

const geometry::Rectangle kRoi{100.0, 70.0, 100.0, 90.0};
const char* const kName = "/reload/tracker";

// A camera that goes on whoever listens.
class RunningCamera {
 public:
  explicit RunningCamera(CameraBench& bench)
      : thread_([this, &bench] {
          const cv::Mat image = test_support::texture(cv::Size(320, 240));
          for (ros::WallRate pace(200.0); !ends_; pace.sleep()) bench.send(image, ros::Time::now());
        }) {}
  ~RunningCamera() {
    ends_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

// Until it `ends`.
std::future<void> changeParameters(const std::atomic<bool>& ends) {
  return std::async(std::launch::async, [&ends] {
    dynamic_reconfigure::Reconfigure call;
    while (!ends) ros::service::call(std::string(kName) + "/set_parameters", call);
  });
}

TEST(TrackerReload, TheManagerSurvivesItAndTheNextOneTracks) {
  CameraBench bench("reload");
  const RunningCamera camera(bench);
  nodelet::Loader loader(false);
  for (int k = 0; k < 8; ++k) {
    ASSERT_TRUE(loader.load(kName, "laparoscope_servo/Tracker", {}, {})) << k;
    std::atomic<bool> ends{false};
    const std::future<void> parameters = changeParameters(ends);
    const auto answer = bench.select(kRoi);
    // At another moment each time, from the first connections on to a region that is tracked.
    std::this_thread::sleep_for(std::chrono::milliseconds(1 + 43 * k));
    EXPECT_TRUE(loader.unload(kName)) << k;
    ends = true;
    answer.wait();
  }
  ASSERT_TRUE(loader.load(kName, "laparoscope_servo/Tracker", {}, {}));
  const SelectRoiResponse answer = bench.select(kRoi).get();
  EXPECT_TRUE(answer.success) << answer.message;
}

// A nodelet that was unloaded lives until its running callback ends, and so do its services.
TEST(TrackerReload, OneWaitsUntilTheOneOfItsNameBeforeHasEnded) {
  CameraBench bench("reload");
  const RunningCamera camera(bench);
  auto before = std::make_unique<NameTurn>();
  before->take(kName, 0.0);
  nodelet::Loader loader(false);
  std::future<bool> loaded =
      std::async(std::launch::async, [&] { return loader.load(kName, "laparoscope_servo/Tracker", {}, {}); });
  // Not a wait for a condition: one that does not wait has a moment to show it.
  EXPECT_EQ(loaded.wait_for(std::chrono::milliseconds(500)), std::future_status::timeout);
  EXPECT_FALSE(ros::service::exists(std::string(kName) + "/select_roi", false));
  before.reset();
  EXPECT_TRUE(loaded.get());
  const SelectRoiResponse answer = bench.select(kRoi).get();
  EXPECT_TRUE(answer.success) << answer.message;
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "tracker_reload");
}
