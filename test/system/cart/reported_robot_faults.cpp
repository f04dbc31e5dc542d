// Faults of arms, lines, processes, machines and clocks.
#include <ros/ros.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "fault_rows.h"
#include "reported_faults.h"

namespace laparoscope_servo::test {

namespace {

FaultRow arm(const std::string& name, Outcome outcome, const std::string& fault, double seconds = 4.0,
             unsigned otherwise = kServo) {
  return watched(other("robot: " + name, 0, otherwise, outcome, kDoubted,
                       [fault](FaultCart& cart) { cart.bench.truth().request("fault " + fault); }),
                 seconds);
}

// While it goes at one speed nothing shows that it is later; what stops it then takes so much longer.
FaultRow later(double seconds, FaultRow row) {
  row.later = seconds;
  return row;
}

// A joint goes faster than the scope that it turns.
FaultRow upTo(double degrees, FaultRow row) {
  row.degrees = degrees;
  return row;
}

std::vector<FaultRow> ofArm() {
  const Outcome either = Outcome::kEither, stands = Outcome::kStands;
  return {
      arm("says that it is disabled", stands, "lie disabled"),
      arm("says that it is enabled", either, "lie enabled"),
      arm("says that nothing moves", either, "lie standing"),
      arm("says that it moves", either, "lie moving"),
      arm("says old positions", either, "lie frozen"),
      arm("says positions 0.2 off", stands, "lie jumped", 0.0, kAll),
      arm("echoes an old request", either, "lie echo_frozen"),
      arm("echoes one that was not sent", stands, "lie echo_ahead", 0.0, kAll),
      arm("joint 1 stands", either, "stalled 1"),
      arm("joint 2 stands", either, "stalled 2"),
      arm("joint 3 stands", either, "stalled 3"),
      arm("joint 7 stands", either, "stalled 7"),
      arm("twice as fast as it is told", either, "gain 2"),
      arm("a third as fast as it is told", either, "gain 0.33"),
      arm("the other way than it is told", stands, "gain -1", 0.0, kAll),
      arm("joint 1 the other way than it is told", either, "reversed 1"),
      upTo(5.0, arm("joint 2 the other way than it is told", stands, "reversed 2", 0.0)),
      arm("joint 7 the other way than it is told", either, "reversed 7"),
      later(0.3, arm("0.3 s later than it was", either, "lag 0.3", 8.0)),
      arm("its controller restarts", stands, "reboot", 0.0, kAll),
      arm("1 in 50 bytes damaged", either, "corrupt 0.02"),
      arm("1 in 50 bytes lost", either, "drop 0.02"),
      arm("1 in 50 bytes twice", either, "double 0.02"),
      arm("bytes 0.1 s late", either, "delay 0.1"),
      arm("bytes 0.25 s late", either, "delay 0.25"),
  };
}

// For less than a second, as a machine that pages, or a debugger.
FaultRow pause(const std::string& name, unsigned situations, const std::function<ChildProcess&(FaultCart&)>& victim) {
  const Begin begin = [victim](FaultCart& cart) {
    victim(cart).kill(SIGSTOP);
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    victim(cart).kill(SIGCONT);
  };
  return watched(other(name + ": pauses for 0.4 s", 0, situations, Outcome::kEither, "SERVO HOLD LOST FAULT", begin),
                 2.5);
}

void restartController(FaultCart& cart) {
  cart.controller.reset();
  cart.startController();
}

// Another process beside one of the cart's, until the fault ends.
FaultRow beside(const std::string& name, const std::string& states, Outcome outcome, const std::string& program,
                const std::vector<std::string>& arguments, const Begin& end) {
  const auto second = std::make_shared<std::unique_ptr<ChildProcess>>();
  return watched(other(
                     name, 0, kServo, outcome, states,
                     [=](FaultCart&) { *second = std::make_unique<ChildProcess>(program, arguments); },
                     [=](FaultCart& cart) {
                       second->reset();
                       end(cart);
                     }),
                 4.0);
}

// With the parameters of the first, the port among them.
void copyParameters(const std::string& from, const std::string& to) {
  XmlRpc::XmlRpcValue parameters;
  ros::param::get(from, parameters);
  ros::param::set(to, parameters);
}

std::vector<FaultRow> ofSeconds() {
  FaultRow robot = beside("robot: a second node on its port", "SERVO", Outcome::kGoesOn, AESOP_NODE, {"__name:=second"},
                          [](FaultCart&) {});
  robot.begin = [begin = robot.begin](FaultCart& cart) {
    copyParameters("/aesop", "/second");
    begin(cart);
  };
  return {
      // ROS ends the first, once the second has started
      beside("controller: a second of its name", "", Outcome::kEither, CONTROLLER, FaultCart::controllerArguments(),
             [](FaultCart& cart) { restartController(cart); }),
      beside("tracker: a second of its name", kLost, Outcome::kEither, TRACKER, FaultCart::trackerArguments(),
             [](FaultCart& cart) {
               cart.tracker.reset();
               cart.startTracker();
             }),
      robot,  // Klipper3d/klipper#1210
  };
}

std::vector<FaultRow> ofMachines() {
  const auto clock = [](const std::string& name, double offset) {
    return watched(
        other(
            "clock: " + name, 0, kAll, Outcome::kEither, kDoubted,
            [offset](FaultCart& cart) { cart.clock.set(offset); }, [](FaultCart& cart) { cart.clock.set(0.0); }),
        4.0);
  };
  FaultRow hangs = process("camera: hangs", &FaultCart::camera, SIGSTOP, {}, kLost);
  FaultRow camera = process(
      "camera: killed, started again", &FaultCart::camera, SIGKILL, [](FaultCart& cart) { cart.startCamera(); }, kLost);
  FaultRow tracker = process(
      "tracker: killed, started again", &FaultCart::tracker, SIGKILL, [](FaultCart& cart) { cart.startTracker(); },
      kLost);
  for (FaultRow* row : {&hangs, &camera, &tracker}) {
    row->usually = 0;
    row->otherwise = kServo | kHold;
  }
  return {
      clock("set ahead by 5 s", 5.0),
      clock("set ahead by 0.3 s", 0.3),
      clock("set back by 5 s", -5.0),
      clock("set back by 0.3 s", -0.3),
      clock("set back by 0.05 s", -0.05),
      hangs,
      camera,
      tracker,
      pause("controller", kAll, [](FaultCart& cart) -> ChildProcess& { return *cart.controller; }),
      pause("tracker", kServo | kHold, [](FaultCart& cart) -> ChildProcess& { return *cart.tracker; }),
      pause("robot's node", kAll, [](FaultCart& cart) -> ChildProcess& { return cart.bench.node(); }),
      other(
          "time: simulated time for who starts now, the controller starts again", 0, kServo, Outcome::kStands, "",
          [](FaultCart& cart) {
            ros::param::set("/use_sim_time", true);
            cart.controller->kill(SIGKILL);
            cart.startController();
          },
          [](FaultCart& cart) {
            ros::param::set("/use_sim_time", false);
            restartController(cart);
          }),
  };
}

}  // namespace

std::vector<FaultRow> reportedRobotFaults() {
  return joined({&ofArm, &ofSeconds, &ofMachines});
}

}  // namespace laparoscope_servo::test
