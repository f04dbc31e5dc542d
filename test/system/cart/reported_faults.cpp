#include "reported_faults.h"

#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <string>

#include "delivery_faults.h"
#include "fault_rows.h"
#include "laparoscope_servo/SelectRoi.h"
#include "laparoscope_servo/SelectTask.h"
#include "laparoscope_servo/StartCalibration.h"
#include "picture_faults.h"
#include "support/reconfigure_client.h"
#include "support/service_call.h"

namespace laparoscope_servo::test {

namespace {

// Watched for so long: what comes of it shows later.
FaultRow either(const std::string& name, double seconds, const std::function<ImageRelay::Fault()>& fault) {
  return watched(image(name, 0, Outcome::kEither, kDoubted, fault), seconds);
}

// It looks like tissue that moves, and is followed as far as the leash reaches.
FaultRow upTo(double degrees, double millimetres, FaultRow row) {
  row.bounded = true;
  row.degrees = degrees;
  row.millimetres = millimetres;
  return row;
}

std::vector<FaultRow> ofDelivery() {
  using namespace image_faults;
  return {
      // ros-drivers/usb_cam#75, #385: stamped when it was read, 0.1 to 0.9 s after it was seen
      either("0.2 s older than their stamps", 8.0, [] { return oldButStampedNow(0.2); }),
      either("0.4 s older than their stamps", 8.0, [] { return oldButStampedNow(0.4); }),
      either("0.8 s older than their stamps", 8.0, [] { return oldButStampedNow(0.8); }),
      // ros-drivers/usb_cam#319: the driver reads more slowly than the camera delivers
      either("of a buffer that fills", 8.0, [] { return filling(0.8); }),
      either("in bursts of five", 3.0, [] { return inBursts(5); }),
      either("each twice", 3.0, doubled),
      either("1 in 2 repeats the one before", 4.0, [] { return repeatedEvery(2); }),
      either("1 in 2 is ten pictures old", 4.0, [] { return oldBetween(10); }),
      either("stand for 0.4 s in each second", 6.0, [] { return stuttering(0.4); }),
      either("later and later, by 0.2 s in a second", 6.0, [] { return laterAndLater(0.2); }),
      either("11 in 12 dropped", 6.0, [] { return only(12); }),
      image("1 in 25 repeats the one before", 0, Outcome::kGoesOn, "", [] { return repeatedEvery(25); }),
      either("1 in 3 with a block of bytes lost", 3.0, [] { return blockLost(3); }),  // tiscamera#139
      either("stamped 0.2 s ago", 8.0, [] { return stamped(-0.2); }),
      either("stamped 0.09 s ahead", 8.0, [] { return stamped(0.09); }),
      either("1 in 12 stamped 5 s ahead", 3.0, [] { return stamped(5.0, 12); }),  // luxonis/depthai-ros#53
      either("stamps that fall behind by 5 %", 8.0, [] { return slowlyStamped(0.95); }),
      // realsense-ros#3498: a counter of 32 bit that begins anew
      image("stamped 71 minutes ago", 0, Outcome::kStands, kDoubted, [] { return stamped(-4295.0); }),
      either("in grey", 4.0, grey),
      image("that are none", kServo, Outcome::kStands, kLost, malformed),
  };
}

std::vector<FaultRow> ofPictures() {
  using namespace image_faults;
  return {
      image("frozen, digitised anew each time", kServo, Outcome::kStands, kDoubted,
            [] { return frozenWithNoise(2.0); }),
      either("of two eyes in turn", 4.0, [] { return everySecond([](cv::Mat& mat) { shift(mat, 24, 0); }); }),
      either("1 in 2 mirrored left to right", 4.0,
             [] { return everySecond([](cv::Mat& mat) { cv::flip(mat.clone(), mat, 1); }); }),
      either("1 in 2 of another camera", 4.0, [] { return otherScene(2); }),
      either("trembling by 6 px", 6.0, [] { return trembling(6); }),
      either("squeezed to three quarters of the height", 4.0,
             [] {
               return warped({1.0, 0.0, 0.0, 0.0, 0.75, 60.0});
             }),
      either("half as large, in a window", 4.0, inAWindow),
      image("white", 0, Outcome::kStands, kLost, white),
      either("in smoke", 4.0, [] { return inSmoke(0.2); }),
      either("out of focus", 4.0, [] { return outOfFocus(6.0); }),
      either("torn", 3.0, torn),  // jvdillon/p3-ir-camera#5, morefigs/pymba#90
      either("interlaced", 3.0, interlaced),
      upTo(22.0, 9.0, either("running through, down by 2 px", 8.0, [] { return runningThrough(0, 2); })),
      upTo(9.0, 7.5, either("running through, to the right by 3 px", 8.0, [] { return runningThrough(3, 0); })),
      either("running through, down by 25 px", 3.0, [] { return runningThrough(0, 25); }),
      either("red for blue", 3.0, swappedColours),  // tentone/tello-ros2#12
      either("with another gamma", 3.0, [] { return gamma(2.2); }),
      either("smoothed over five", 8.0, [] { return smoothed(5.0); }),
      either("JPEG of quality 5", 3.0, [] { return compressed(5); }),
      either("side by side", 3.0, sideBySide),
      image("behind a menu", 0, Outcome::kStands, kLost, menu),
      image("the grabber's test picture", 0, Outcome::kStands, kDoubted, testPicture),
      upTo(3.5, 4.5, either("turned by hand", 8.0, [] { return turning(20.0, 150.0); })),
      // What it pans towards the region meanwhile is in it.
      upTo(6.0, 16.0, either("zoomed in by hand", 8.0, [] { return zooming(1.3, 2.0); })),
      upTo(5.0, 5.0, either("zoomed out by hand", 8.0, [] { return zooming(1.3, 0.5); })),
      either("stabilised by the camera", 8.0, stabilised),
  };
}

SelectRoi::Request region(int x, int y) {
  SelectRoi::Request request;
  request.roi.x_offset = static_cast<std::uint32_t>(x);
  request.roi.y_offset = static_cast<std::uint32_t>(y);
  request.roi.width = request.roi.height = 100;
  return request;
}

void select(int x, int y) {
  SelectRoi call;
  call.request = region(x, y);
  test_support::callWithin("tracker/select_roi", call);
}

void select(const std::string& task) {
  SelectTask call;
  call.request.task = task;
  test_support::callWithin("controller/select_task", call);
}

void ask(const std::string& service) {
  std_srvs::Trigger call;
  test_support::callWithin(service, call);
}

void calibrate() {
  StartCalibration call;
  call.request.method = "HAND";
  test_support::callWithin("aesop/calibrate_insertion_point/start", call);
}

// All to what a tool of dynamic_reconfigure lets choose at most.
void gains(double value) {
  test_support::ReconfigureClient client("/controller");
  client.set([value](auto& config) {
    for (const char* name : {"features__centre", "features__depth", "features__orientation"})
      test_support::ReconfigureClient::add(config, name, value);
  });
}

// Up to `count` times: a node that hangs answers none of the calls, and each takes its whole time then.
void repeat(int count, const std::function<void(int)>& act) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(30.0);
  for (int k = 0; k < count && ros::WallTime::now() < end; ++k) act(k);
}

std::vector<FaultRow> ofServices() {
  const auto in_servo = [](
                            const std::string& name, Outcome outcome, const std::string& states, const Begin& begin,
                            const Begin& end = [](FaultCart&) {}) {
    return other(name, 0, kServo, outcome, states, begin, end);
  };
  return {
      in_servo("region: another is selected", Outcome::kEither, std::string("SERVO ") + kDoubted,
               [](FaultCart&) { select(40, 300); }),
      in_servo("region: 30 others, one after the other", Outcome::kEither, kDoubted,
               [](FaultCart&) { repeat(30, [](int k) { select(20 * k % 500, 37 * k % 350); }); }),
      in_servo("region: forgotten", Outcome::kStands, kLost, [](FaultCart&) { ask("tracker/reset"); }),
      in_servo("task: changed 100 times", Outcome::kEither, kDoubted,
               [](FaultCart&) {
                 repeat(50, [](int) {
                   select(ControllerState::MANUAL);
                   select(ControllerState::HOLD_VIEW);
                 });
               }),
      in_servo("engaged 200 times", Outcome::kGoesOn, "",
               [](FaultCart& cart) { repeat(200, [&](int) { cart.engage(true); }); }),
      in_servo("engaged and disengaged 100 times", Outcome::kStands, "ARMED HOLD LOST",
               [](FaultCart& cart) { repeat(200, [&](int k) { cart.engage(k % 2 == 1); }); }),
      other("robot: enabled, resumed, cleared 50 times", 0, kServo | kManual, Outcome::kEither, kDoubted,
            [](FaultCart& cart) {
              repeat(50, [&](int) {
                for (const char* service : {"enable", "resume", "clear_fault"}) cart.robot(service);
              });
            }),
      other(
          "robot: a calibration begins", 0, kServo | kManual, Outcome::kEither, kDoubted,
          [](FaultCart&) { calibrate(); }, [](FaultCart&) { ask("aesop/calibrate_insertion_point/cancel"); }),
      watched(in_servo(
                  "gains: the highest", Outcome::kEither, kDoubted, [](FaultCart&) { gains(20.0); },
                  [](FaultCart&) { gains(8.0); }),
              8.0),
  };
}

std::vector<FaultRow> ofHands() {
  return {
      other("dead-man switch: bounces", kManual, kServo | kManual, Outcome::kEither, "ARMED SERVO HOLD LOST",
            [](FaultCart& cart) { cart.operating.bounceSwitch(); }),
      // turtlebot/turtlebot_apps#55: a stick that does not go back to zero
      other("stick: released, and trembles about its rest", kManual, kManual, Outcome::kStands, "SERVO",
            [](FaultCart& cart) { cart.operating.push(0.0012, 0.0002); }),
  };
}

}  // namespace

std::vector<FaultRow> reportedFaults() {
  return joined({&ofDelivery, &ofPictures, &ofServices, &ofHands, &reportedRobotFaults});
}

}  // namespace laparoscope_servo::test
