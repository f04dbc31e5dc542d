#include "fault_table.h"

#include <cmath>

#include "fault_rows.h"
#include "reported_faults.h"

namespace laparoscope_servo::test {

namespace {

std::vector<FaultRow> ofImages() {
  using namespace image_faults;
  return {
      alsoInOtherTasks(image("frozen", kServo | kHold, Outcome::kStands, kDoubted, frozen)),
      image("frozen where the region is", kServo, Outcome::kStands, kDoubted, frozenInside),
      image("half of the last", kServo, Outcome::kStands, kDoubted, half),
      inTurn("two", 2),
      alsoInOtherTasks(inTurn("twelve", 12)),
      image("swapped in pairs", kServo, Outcome::kEither, kLost, swapped),
      alsoInOtherTasks(image("mirrored left to right", kServo, Outcome::kStands, kDoubted, [] { return flipped(1); })),
      image("mirrored upside down", 0, Outcome::kStands, kDoubted, [] { return flipped(0); }),
      alsoInOtherTasks(image("rolled by 180 degrees", kServo, Outcome::kStands, kDoubted, [] { return flipped(-1); })),
      image("mirrored and rolled by 90 degrees", 0, Outcome::kStands, kDoubted, flippedAndTurned),
      image("shifted by 40 px", 0, Outcome::kEither, kDoubted,
            [] {
              return warped({1.0, 0.0, 40.0, 0.0, 1.0, 0.0});
            }),
      image("enlarged by a quarter", 0, Outcome::kEither, kDoubted,
            [] {
              return warped({1.25, 0.0, -80.0, 0.0, 1.25, -60.0});
            }),
      alsoInOtherTasks(image("of another size", kServo, Outcome::kStands, kLost, [] { return resized(320, 240); })),
      image("of one pixel", kServo, Outcome::kStands, kLost, [] { return resized(1, 1); }),
      alsoInOtherTasks(image("late by 0.5 s", kServo, Outcome::kStands, kLost, [] { return late(0.5); })),
      image("1 in 5 stamped 30 ms early", kServo, Outcome::kEither, kLost, [] { return stamped(-0.03, 5); }),
      image("1 in 5 stamped 1 s ahead", kServo, Outcome::kEither, kLost, [] { return stamped(1.0, 5); }),
      alsoInOtherTasks(image("stamped 5 s ago", 0, Outcome::kStands, kDoubted, [] { return stamped(-5.0); })),
      image("stamped 1 s ahead", kServo, Outcome::kStands, kLost, [] { return stamped(1.0); }),
      image("stamped unevenly, 0 to 0.1 s later", kServo, Outcome::kGoesOn, "", [] { return unevenlyStamped(0.1); }),
      image("all of one stamp", kServo, Outcome::kStands, kLost, [] { return slowlyStamped(0.0); }),
      image("stamps that go half as fast", 0, Outcome::kStands, kLost, [] { return slowlyStamped(0.5); }),
      alsoInOtherTasks(image("without stamps", kServo, Outcome::kStands, kLost, unstamped)),
      image("flickering", kServo, Outcome::kEither, kLost, flickering),
      alsoInOtherTasks(image("black", kServo, Outcome::kStands, kLost, black)),
      alsoInOtherTasks(image("none", kServo | kHold, Outcome::kStands, kLost, silent)),
      image("1 in 2 dropped", kServo, Outcome::kEither, kLost, [] { return dropped(2); }),
      image("1 in 10 dropped", 0, Outcome::kGoesOn, "", [] { return dropped(10); }),
      image("1 in 50 dropped", 0, Outcome::kGoesOn, "", [] { return dropped(50); }),
      image("1 in 4 of another camera", kServo, Outcome::kEither, kLost, [] { return otherScene(4); }),
      alsoInOtherTasks(image("of another camera", kServo, Outcome::kStands, kLost, [] { return otherScene(1); })),
      image("of an encoding that they are not in", 0, Outcome::kStands, kLost, mislabelled),
  };
}

// Another's features, beside those of the tracker, and in their place.
FaultRow byFeatures(Situation situation, const std::string& topic, const std::string& says) {
  return stranger("features: another's", static_cast<unsigned>(situation), 0, Outcome::kGoesOn, "HOLD", topic, says,
                  25.0);
}

FaultRow silentByFeatures(Situation situation, const std::string& topic, const std::string& says) {
  return stranger("features: silent, another's", static_cast<unsigned>(situation), 0, Outcome::kStands, kLost, topic,
                  says, 25.0, [](FaultCart& cart) { cart.relay->begin(image_faults::silent()); });
}

std::vector<FaultRow> ofInputs() {
  return {
      other("dead-man switch: released", kServo | kManual, kAll, Outcome::kStands, "ARMED HOLD LOST",
            [](FaultCart& cart) { cart.operating.press(false); }),
      other("dead-man switch: silent", kServo, kAll, Outcome::kStands, "ARMED HOLD LOST",
            [](FaultCart& cart) { cart.operating.dropSwitch(); }),
      stranger("dead-man switch: released, another says pressed", kServo, kServo, Outcome::kStands, "ARMED HOLD LOST",
               "dead_man", "pressed", 50.0, [](FaultCart& cart) { cart.operating.press(false); }),
      other("stick: silent", kManual, kManual, Outcome::kStands, "SERVO",
            [](FaultCart& cart) { cart.operating.dropStick(); }),
      other("stick: not a number", kManual, kManual, Outcome::kStands, "SERVO HOLD",
            [](FaultCart& cart) { cart.operating.push(std::nan("")); }),
      other("stick: stamped a minute ahead", kManual, kManual, Outcome::kStands, "SERVO HOLD",
            [](FaultCart& cart) { cart.operating.shiftStamps(60.0); }),
      other("stick: stamped a second ago", kManual, kManual, Outcome::kStands, "SERVO HOLD",
            [](FaultCart& cart) { cart.operating.shiftStamps(-1.0); }),
      stranger("stick: silent, another drives", kManual, kManual, Outcome::kStands, "SERVO", "controller/manual",
               "velocity", 50.0, [](FaultCart& cart) { cart.operating.dropStick(); }),
      stranger("stick: another's, not a number, 10 kHz", 0, kManual, Outcome::kEither, "SERVO HOLD",
               "controller/manual", "velocity_nan", 1e4),
      stranger("task error: another's", kServo, kServo | kHold, Outcome::kGoesOn, "HOLD", "tracker/task_error",
               "elsewhere", 25.0),
      stranger("task error: another's, 10 kHz", 0, kServo | kHold, Outcome::kEither, kLost, "tracker/task_error",
               "elsewhere", 1e4),
      stranger("task error: silent, another's", kServo, kServo | kHold, Outcome::kStands, kLost, "tracker/task_error",
               "elsewhere", 25.0, [](FaultCart& cart) { cart.relay->begin(image_faults::silent()); }),
      stranger("measured velocity: another's", 0, kServo, Outcome::kEither, kDoubted, "aesop/measured_cv", "measured",
               50.0),
      alsoInOtherTasks(stranger("camera_info: another's, of twice the focal length", 0, kServo, Outcome::kGoesOn, "",
                                "relayed/camera_info", "intrinsics", 25.0)),
      byFeatures(Situation::kFollow, "motion/features", "object_elsewhere"),
      byFeatures(Situation::kPoints, "points/features", "points_elsewhere"),
      byFeatures(Situation::kPosition, "tracker/homography", "homography_elsewhere"),
      silentByFeatures(Situation::kFollow, "motion/features", "object_elsewhere"),
      silentByFeatures(Situation::kPoints, "points/features", "points_elsewhere"),
      silentByFeatures(Situation::kPosition, "tracker/homography", "homography_elsewhere"),
      stranger("images: another's", kServo, kServo | kHold, Outcome::kEither, kDoubted, "relayed/image_raw", "grey",
               25.0),
  };
}

// Of the camera itself, whose images stay what they are.
FaultRow cameraInfo(const std::string& name, unsigned usually, const std::function<CameraInfoRelay::Fault()>& fault) {
  return other("camera_info: " + name, usually, kServo | kOtherTasks, Outcome::kStands, kLost,
               [fault](FaultCart& cart) { cart.info_relay->begin(fault()); });
}

std::vector<FaultRow> ofCameraInfo() {
  const auto changed = [](const std::function<void(sensor_msgs::CameraInfo&)>& change) {
    return [change] {
      return [change](sensor_msgs::CameraInfo info) {
        change(info);
        return info;
      };
    };
  };
  FaultRow alternating =
      cameraInfo("of twice the focal length, every second one", 0, [] { return onEverySecond(withFocalLength(2.0)); });
  alternating.outcome = Outcome::kEither;  // it goes on by those that are true
  return {
      cameraInfo("of twice the focal length", kServo, [] { return withFocalLength(2.0); }),
      alternating,
      cameraInfo("its principal point jumps by 40 px", 0, [] { return withPrincipalPoint(40.0, 0.0); }),
      cameraInfo("of images of half the size", 0, changed([](sensor_msgs::CameraInfo& info) {
                   info.width /= 2;
                   info.height /= 2;
                 })),
      cameraInfo("not a number", 0, [] { return withFocalLength(std::nan("")); }),
      other("camera_info: no more", 0, kServo | kOtherTasks, Outcome::kGoesOn, "",
            [](FaultCart& cart) { cart.info_relay->cut(); }),
  };
}

// Not for long: together with another fault it may never come.
void awaitRobot(FaultCart& cart, const std::string& state) {
  constexpr double kPatience = 5.0;  // s
  cart.bench.waitFor([&] { return cart.bench.stateIs(state); }, kPatience);
}

void disableAndEnable(FaultCart& cart) {
  cart.robot("disable");
  awaitRobot(cart, "DISABLED");
  cart.robot("enable");
  awaitRobot(cart, "ENABLED");
}

// By the arm's own button, and back as fast as somebody can.
void emergencyStopAndBack(FaultCart& cart) {
  cart.bench.truth().fault("bits", 4.0);
  awaitRobot(cart, "FAULT");
  cart.bench.truth().fault("bits", 0.0);
  cart.robot("clear_fault");
  awaitRobot(cart, "DISABLED");
  cart.robot("enable");
  awaitRobot(cart, "ENABLED");
}

std::vector<FaultRow> ofRobot() {
  return {
      other("robot: disabled, enabled again", kAll, kAll, Outcome::kStands, "LOST", disableAndEnable),
      other("robot: emergency stop, cleared, enabled again", kServo, kAll, Outcome::kStands, "LOST",
            emergencyStopAndBack),
      stranger("robot: disabled, another says ENABLED", kServo, kAll, Outcome::kStands, "LOST HOLD",
               "aesop/operating_state", "enabled", 100.0, [](FaultCart& cart) { cart.robot("disable"); }),
      other("robot: paused", kServo, kAll, Outcome::kStands, kLost, [](FaultCart& cart) { cart.robot("pause"); }),
      other("robot: a motor trips", 0, kAll, Outcome::kStands, kDoubted,
            [](FaultCart& cart) { cart.bench.truth().fault("joint", 2.0); }),
      other("robot: the port goes away", kServo, kAll, Outcome::kStands, kDoubted,
            [](FaultCart& cart) { cart.bench.truth().request("fault hangup for 1"); }),
      other("robot: the line is silent", 0, kAll, Outcome::kStands, kDoubted,
            [](FaultCart& cart) { cart.bench.truth().request("fault stall for 1"); }),
  };
}

std::vector<FaultRow> ofProcesses() {
  std::vector<FaultRow> rows{
      process(
          "controller: killed, started again", &FaultCart::controller, SIGKILL,
          [](FaultCart& cart) { cart.startController(); }, ""),
      process("tracker: hangs", &FaultCart::tracker, SIGSTOP, {}, kLost),
      process("controller: hangs", &FaultCart::controller, SIGSTOP, {}, ""),
      other(
          "robot's node: hangs", kServo, kAll, Outcome::kStands, kLost,
          [](FaultCart& cart) { cart.bench.node().kill(SIGSTOP); },
          [](FaultCart& cart) { cart.bench.node().kill(SIGCONT); }),
  };
  for (FaultRow& row : rows) {
    if (row.name != "tracker: hangs") continue;
    row.otherwise = kServo | kHold;
    row.usually |= kOtherTasks | kParallel;
  }
  return rows;
}

std::vector<FaultRow> ofFrames() {
  const auto row = [&](const std::string& name, unsigned usually, const std::string& says) {
    return stranger("tf: " + name, usually, kServo | kHold, Outcome::kEither, kDoubted, "/tf", says, 50.0);
  };
  return {
      row("another's camera, 50 mm off", kServo | kOtherTasks, "tip_off"),
      row("another's camera, not a number", 0, "tip_nan"),
      row("another's shaft, 50 mm off", kServo, "shaft_off"),
      row("another's insertion point", kServo, "trocar_off"),
      stranger("tf_static: another's shaft, 50 mm off", 0, kServo | kHold, Outcome::kEither, kDoubted, "/tf_static",
               "shaft_off", 50.0),
  };
}

}  // namespace

const std::vector<FaultRow>& faultTable() {
  static const std::vector<FaultRow> table =
      joined({&ofImages, &ofInputs, &ofCameraInfo, &ofRobot, &ofFrames, &ofProcesses, &reportedFaults});
  return table;
}

}  // namespace laparoscope_servo::test
