#include "fault_cart.h"

#include <std_srvs/SetBool.h>

#include <algorithm>
#include <cstdio>
#include <limits>

#include "laparoscope_servo/SelectRoi.h"
#include "laparoscope_servo/SelectTask.h"
#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/sim/arm.h"
#include "ros/common/parameters.h"
#include "support/service_call.h"

namespace laparoscope_servo::test {

namespace {

constexpr int kRoiX = 260, kRoiY = 180, kRoiSide = 120;  // px
constexpr double kPan = 0.16;                            // rad, from where the region is seen in its place
constexpr double kHand = 0.4;                            // s, that a hand takes

XmlRpc::XmlRpcValue config(const std::string& name) {
  return parametersFromYaml(std::string(LAPAROSCOPE_SERVO_CONFIG) + "/" + name);
}

}  // namespace

const char* name(Situation situation) {
  switch (situation) {
    case Situation::kServo:
      return "SERVO";
    case Situation::kHold:
      return "HOLD";
    case Situation::kManual:
      return "MANUAL";
  }
  return "";
}

FaultCart::FaultCart() {
  XmlRpc::XmlRpcValue camera_parameters = config("simulation.yaml");
  camera_parameters["tissue"]["texture_side"] = 1200;
  camera_parameters["control"] = bench.file("control");
  ros::param::set("/simulated_camera", camera_parameters);
  ros::param::set("/tracker", config("tracker.yaml"));
  ros::param::set("/controller", config("controller.yaml"));
  ros::param::set("/controller/safety/robot_required", true);
  ros::param::set("/controller/safety/dead_man_required", true);
  // The switch and the stick are in the hands of this test.
  ros::param::set("/controller/owners/dead_man", ros::this_node::getName());
  ros::param::set("/controller/owners/manual", ros::this_node::getName());
  home_ = bench.truth().state().q;
  bench.master_ = "/controller";
  bench.startNode();
  relay = std::make_unique<ImageRelay>("image_raw", "relayed/image_raw");
  subscribers_ = {
      node_.subscribe<ControllerState>("controller/state", 10, [this](const auto& message) { state_ = *message; }),
      node_.subscribe<Homography>("tracker/homography", 10, [this](const auto& message) { homography_ = *message; })};
  startCamera();
  startTracker();
  startController();
}

void FaultCart::startCamera() {
  camera = std::make_unique<ChildProcess>(SIMULATED_CAMERA, std::vector<std::string>{"__name:=simulated_camera"});
}

void FaultCart::startTracker() {
  tracker = std::make_unique<ChildProcess>(TRACKER, trackerArguments());
}

void FaultCart::startController() {
  controller = std::make_unique<ChildProcess>(CONTROLLER, controllerArguments());
}

std::vector<std::string> FaultCart::trackerArguments() {
  return {"__name:=tracker", "image:=relayed/image_raw"};
}

std::vector<std::string> FaultCart::controllerArguments() {
  return {"__name:=controller", "task_error:=tracker/task_error", "operating_state:=aesop/operating_state",
          "measured_cv:=aesop/measured_cv"};
}

std::string FaultCart::waitFor(const char* what, const std::function<bool()>& condition, double seconds) {
  return bench.waitFor(condition, seconds) ? "" : std::string("waited in vain for ") + what;
}

std::string FaultCart::waitWhileEngaged(const char* what, const std::function<bool()>& condition) {
  bool reached = false;
  bench.waitFor([&] { return (reached = condition()) || stateIs("LOST") || stateIs("FAULT"); });
  return reached ? "" : std::string("waited in vain for ") + what;
}

std::string FaultCart::engage(bool on) {
  std_srvs::SetBool call;
  call.request.data = static_cast<std::uint8_t>(on);
  if (!test_support::callWithin("controller/engage", call)) return "controller/engage does not answer";
  ros::spinOnce();
  return call.response.success ? "" : call.response.message;
}

std::string FaultCart::robot(const std::string& service) {
  std_srvs::Trigger call;
  if (!test_support::callWithin("aesop/" + service, call)) return "aesop/" + service + " does not answer";
  ros::spinOnce();
  return call.response.success ? "" : call.response.message;
}

double FaultCart::offset() const {
  if (!homography_ || homography_->state != Homography::TRACKING) return std::numeric_limits<double>::infinity();
  double x = 0.0, y = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    x += homography_->corners[2 * k] / 4.0;
    y += homography_->corners[2 * k + 1] / 4.0;
  }
  const double middle = (kRoiSide - 1) / 2.0;
  return std::hypot(x - kRoiX - middle, y - kRoiY - middle);
}

// On a machine that is too busy for it, the emulator may fall silent or pictures come late, and the cart stops as it
// has to: then the steps are taken again.
std::string FaultCart::bringTo(Situation situation) {
  constexpr int kAttempts = 4;
  std::string problem;
  for (int k = 0; k < kAttempts; ++k) {
    problem = tryToBringTo(situation);
    if (problem.empty()) return "";
    std::printf("not brought to %s: %s\n", name(situation), problem.c_str());
  }
  return problem;
}

std::string FaultCart::tryToBringTo(Situation situation) {
  for (const auto step : {&FaultCart::stand, &FaultCart::see}) {
    const std::string problem = (this->*step)();
    if (!problem.empty()) return problem;
  }
  return go(situation);
}

// Everything that may move the arm is taken back: switch, engagement, the robot.
std::string FaultCart::stand() {
  operating.shiftStamps(0.0);
  operating.push(0.0);
  operating.press(false);
  relay->end();
  bench.truth().request("forget");
  bench.truth().fault("none");
  if (!ros::service::waitForService("controller/engage", 10000)) return "the controller does not start";
  std::string problem = waitFor("the controller's state", [this] { return state_.has_value(); });
  if (problem.empty()) problem = engage(false);
  if (problem.empty()) problem = waitFor("IDLE", [this] { return stateIs("IDLE"); });
  if (problem.empty()) problem = waitFor("the line", [this] { return bench.isUp(); });
  if (problem.empty() && bench.stateIs("FAULT")) problem = robot("clear_fault");
  // An arm that moves may take longer than the node waits for.
  if (problem.empty())
    problem =
        waitFor("a robot that is disabled", [this] { return bench.stateIs("DISABLED") || robot("disable").empty(); });
  if (problem.empty()) {
    problem =
        waitFor("a robot at rest", [this] { return bench.stateIs("DISABLED") && !bench.truth().motion().moving; });
  }
  return problem;
}

// The region in its place first, where it is not tracked; then the scope a little to the side of it.
std::string FaultCart::see() {
  hand(home_);
  // Within a second when it was never lost, later where it has to be found again.
  homography_.reset();
  if (!bench.waitFor([this] { return offset() < 10.0; }, 1.5)) {
    if (!ros::service::waitForService("tracker/select_roi", 10000)) return "the tracker does not start";
    SelectRoi select;
    select.request.roi.x_offset = kRoiX;
    select.request.roi.y_offset = kRoiY;
    select.request.roi.width = select.request.roi.height = kRoiSide;
    const auto selected = [&] {
      return test_support::callWithin("tracker/select_roi", select) && select.response.success;
    };
    if (!bench.waitFor(selected, 20.0)) return "no region: " + select.response.message;
  }
  const std::string problem = waitFor("the region in its place", [this] { return offset() < 5.0; });
  if (!problem.empty()) return problem;
  bench.truth().hand({kPan, 0.02, 0.0, 0.0}, kHand);
  bench.waitFor([this] { return !bench.truth().motion().moving; });
  return waitFor("the region beside its place", [this] { return std::isfinite(offset()) && offset() > 50.0; });
}

// By a hand about the trocar, to where the scope was with these joints.
void FaultCart::hand(const aesop::JointVector& goal) {
  const aesop::JointVector now = bench.truth().state().q;
  if ((now - goal).cwiseAbs().maxCoeff() < 1e-4) return;
  const Eigen::Vector3d trocar = sim::ArmConfig().insertion_point;
  const Eigen::Isometry3d from = kinematics_.optical(now), to = kinematics_.optical(goal);
  const Eigen::Vector3d turn = geometry::so3Log(from.linear().transpose() * to.linear());
  const double deeper = (to.translation() - trocar).norm() - (from.translation() - trocar).norm();
  bench.truth().hand({turn.y(), turn.x(), turn.z(), deeper}, kHand);
  bench.waitFor([this] { return !bench.truth().motion().moving; });
}

std::string FaultCart::go(Situation situation) {
  const bool manual = situation == Situation::kManual;
  SelectTask task;
  task.request.task = manual ? ControllerState::MANUAL : ControllerState::HOLD_VIEW;
  if (!test_support::callWithin("controller/select_task", task)) return "controller/select_task does not answer";
  if (!task.response.success) return task.response.message;
  // A line that is up may be lost once more on a busy machine.
  std::string problem = waitFor("an enable", [this] { return robot("enable").empty(); });
  if (problem.empty()) problem = waitFor("ENABLED", [this] { return bench.stateIs("ENABLED"); });
  std::string refusal;
  // The controller may hear of it a moment later.
  if (problem.empty() && !bench.waitFor([&] { return (refusal = engage(true)).empty(); })) problem = refusal;
  if (problem.empty()) problem = waitFor("ARMED", [this] { return stateIs("ARMED"); });
  if (!problem.empty()) return problem + " (" + state() + ": " + reason() + ")";
  // A switch counts once it was seen released.
  const int told = operating.told();
  bench.waitFor([&] { return operating.told() > told + 2; });
  operating.press(true);
  problem = waitWhileEngaged("SERVO", [this] { return stateIs("SERVO"); });
  if (!problem.empty()) return problem + " (" + state() + ": " + reason() + ")";
  if (manual) operating.push(kStick);
  problem = waitWhileEngaged("motion", [this] { return std::abs(bench.truth().motion().qdot[1]) > 0.02; });
  if (problem.empty() && situation == Situation::kHold) {
    relay->cover();
    problem = waitWhileEngaged("HOLD", [this] { return stateIs("HOLD") && !bench.jointsMove(); });
  }
  return problem.empty() ? "" : problem + " (" + state() + ": " + reason() + ")";
}

void FaultCart::mark() {
  marked_ = bench.truth().state().q;
  marked_at_ = steadyNow();
}

Reaction FaultCart::watch(double seconds, double calm) {
  Reaction reaction;
  double moved = marked_at_;
  const double begin = steadyNow();  // later than the mark by what the fault itself takes
  const double distance = travel(kinematics_, marked_, home_).degrees;
  const double lately = begin + seconds - 2.0;
  std::optional<aesop::JointVector> lowest, highest;
  bench.waitFor(
      [&] {
        const aesop::JointVector now = bench.truth().state().q;
        reaction.travel.atLeast(travel(kinematics_, marked_, now));
        reaction.nearer = distance - travel(kinematics_, now, home_).degrees;
        reaction.away = std::max(reaction.away, -reaction.nearer);
        if (bench.jointsMove()) moved = steadyNow();
        if (steadyNow() > lately) {
          lowest = lowest ? lowest->cwiseMin(now) : now;
          highest = highest ? highest->cwiseMax(now) : now;
        }
        return steadyNow() - std::max(moved, begin) >= calm;
      },
      seconds);
  if (lowest) reaction.swing = travel(kinematics_, *lowest, *highest).degrees;
  reaction.stood = moved - marked_at_;
  reaction.lasted = steadyNow() - marked_at_;
  reaction.state = state();
  reaction.reason = reason();
  reaction.robot = bench.state_ ? bench.state_->state : "";
  return reaction;
}

}  // namespace laparoscope_servo::test
