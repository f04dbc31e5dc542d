// The controller's task PARALLEL: what it is told, and what moves the scope by it.
#include "servo/controller_implementation.h"

namespace laparoscope_servo::servo {

// The end of the circle ends the engagement, so that somebody reads what the turn will do before it begins.
void Controller::Implementation::watchPlane(const ControllerInput& input) {
  if (!input.clock_jump.empty()) parallel_.restart();
  if (task_ != Task::kParallel) return;
  if (!engaged()) parallel_.leaveCircle();
  const DepthInput& depth = input.depth;
  const bool pose_counts = depth.problem.empty() && depth.insertion_point_T_tip && depth.pose_is_new &&
                           depth.d2 > 0.0 && depth.age <= config_.safety.max_depth_age;
  const TaskErrorInput& view = seen(input);
  if (isUsable(input) && view.motion && problemOf(view).empty())
    parallel_.see(*view.image_time, view.region, *view.motion, machine_.state() == SafetyState::kServo);
  if (pose_counts) {
    parallel_.move({input.time - depth.age, *depth.insertion_point_T_tip, {depth.camera_R_shaft, d2(input)}},
                   servo_.history(), servo_.delay());
  }
  if (engaged() && parallel_.stage() == ParallelStage::kAnnounced) end(parallel_.announcement(), input.time);
}

// What has failed counts until somebody engages again.
std::string Controller::Implementation::planeProblem(const ControllerInput& input) const {
  const bool is_posed = !input.depth.problem.empty() || input.depth.insertion_point_T_tip;
  if (!is_posed) return "the shaft's pose is not known, which PARALLEL needs";
  return engaged() ? parallel_.problem() : "";
}

// Round the circle by velocities, without the law: it ends where it began, whatever the poses' noise.
scope::Velocity Controller::Implementation::faceTissue(const ControllerInput& input, const SafetyOutput& safety) {
  const ServoInput servo = servoInput(input);
  if (parallel_.stage() == ParallelStage::kTurn) return servo_.command(servo, limits(safety, input.time));
  if (parallel_.stage() == ParallelStage::kSettles) return servo_.drive(servo, scope::Velocity());
  if (parallel_.stage() == ParallelStage::kUnknown) parallel_.engage(input.time);  // selected while engaged
  const scope::Velocity round = parallel_.circle(safety.speed_scale * servo.period);
  return servo_.drive(servo, scope::Velocity::fromVector(safety.speed_scale * round.vector()));
}

}  // namespace laparoscope_servo::servo
