#include "fault_cart.h"

#include <std_srvs/SetBool.h>

#include <algorithm>
#include <cstdio>

#include "laparoscope_servo/SelectTask.h"
#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/sim/arm.h"
#include "ros/common/parameters.h"
#include "support/service_call.h"

namespace laparoscope_servo::test {

namespace {

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
    case Situation::kFollow:
      return "FOLLOW";
    case Situation::kPoints:
      return "POINTS";
    case Situation::kPosition:
      return "POSITION";
    case Situation::kParallel:
      return "PARALLEL";
  }
  return "";
}

FaultCart::FaultCart() {
  XmlRpc::XmlRpcValue camera_parameters = config("simulation.yaml");
  camera_parameters["tissue"]["texture_side"] = 1200;
  camera_parameters["control"] = bench.file("control");
  ros::param::set("/simulated_camera", camera_parameters);
  ros::param::set("/tracker", config("tracker.yaml"));
  for (const FeatureTask* task : {&kFollowTask, &kPointsTask}) {
    ros::param::set(std::string("/") + task->node, config(std::string(task->node) + ".yaml"));
  }
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
  info_relay = std::make_unique<CameraInfoRelay>("camera_info", "relayed/camera_info");
  subscribers_ = {
      node_.subscribe<ControllerState>("controller/state", 10, [this](const auto& message) { state_ = *message; }),
      node_.subscribe<Homography>("tracker/homography", 10, [this](const auto& message) { homography_ = *message; })};
  for (const FeatureTask* task : {&kFollowTask, &kPointsTask}) {
    subscribers_.push_back(node_.subscribe<TrackedFeatures>(std::string(task->node) + "/features", 10,
                                                            [this](const auto& message) { features_ = *message; }));
  }
  startCamera();
  startTracker();
  startController();
}

void FaultCart::startCamera() {
  camera = std::make_unique<ChildProcess>(SIMULATED_CAMERA, std::vector<std::string>{"__name:=simulated_camera"});
}

void FaultCart::startTracker() {
  if (by_features_ == nullptr) {
    tracker = std::make_unique<ChildProcess>(TRACKER, trackerArguments());
  } else {
    tracker = std::make_unique<ChildProcess>(NODELET, by_features_->arguments());
  }
}

void FaultCart::startController() {
  controller = std::make_unique<ChildProcess>(CONTROLLER, controllerArguments());
}

std::vector<std::string> FaultCart::trackerArguments() {
  return {"__name:=tracker", "image:=relayed/image_raw", "camera_info:=relayed/camera_info"};
}

std::vector<std::string> FaultCart::controllerArguments() {
  return {"__name:=controller",
          "camera_info:=relayed/camera_info",
          "task_error:=tracker/task_error",
          "operating_state:=aesop/operating_state",
          "measured_cv:=aesop/measured_cv",
          "motion_features:=motion/features",
          "points_features:=points/features",
          "homography:=tracker/homography"};
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
  use(situation);
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
  info_relay->end();
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

std::string FaultCart::go(Situation situation) {
  const bool manual = situation == Situation::kManual;
  SelectTask task;
  task.request.task = manual ? ControllerState::MANUAL : ControllerState::HOLD_VIEW;
  if (by_features_ != nullptr) task.request.task = by_features_->task;
  if (situation == Situation::kPosition) task.request.task = ControllerState::POSITION;
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
