// What the controller sees by its present task, what is wrong with it, and what watches it.
#include <cmath>
#include <utility>

#include "servo/controller_implementation.h"

namespace laparoscope_servo::servo {

namespace {

// s, beyond the delay, after which a motion must be visible in the image. Derived: a command reaches the limit of 0.1
// rad/s by 1 rad/s^2 in 0.1 s (limits/), and in half of that it has moved the picture by 1 px at a focal length of 800
// px.
constexpr double kShows = 0.1;

}  // namespace

const TaskErrorInput& ControllerInput::seenBy(Task task) const {
  switch (task) {
    case Task::kStabilise:
    case Task::kParallel:
      return view;
    case Task::kCentreTip:
      return tip;
    case Task::kFollow:
      return object;
    case Task::kPoints:
      return points;
    case Task::kPosition:
      return position;
    case Task::kHoldView:
    case Task::kManual:
      break;
  }
  return task_error;
}

TaskErrorInput& ControllerInput::seenBy(Task task) {
  return const_cast<TaskErrorInput&>(std::as_const(*this).seenBy(task));
}

const TaskErrorInput& Controller::Implementation::seen(const ControllerInput& input) const {
  return input.seenBy(task_);
}

std::string Controller::Implementation::problemOf(const TaskErrorInput& seen) const {
  const std::string impossible = implausible(seen);
  if (!impossible.empty()) return impossible;
  if (task_ == Task::kStabilise && !(seen.corner_error <= config_.stabilise.max_error))
    return "where the view is, is not known well enough: its expected error is above stabilise/max_error";
  if (task_ == Task::kCentreTip) {
    const CentreTipConfig& c = config_.centre_tip;
    if (!(seen.corner_error <= c.max_error))
      return "where the tip is, is not known well enough: its expected error is above centre_tip/max_error";
    if (!(std::hypot(seen.error.x - c.x, seen.error.y - c.y) <= c.leave))
      return "the tip leaves: it is further from the zone's middle than centre_tip/leave";
  }
  if (task_ == Task::kFollow && !(seen.corner_error <= config_.follow.max_error))
    return "where the object is, is not known well enough: its expected error is above follow/max_error";
  if (task_ == Task::kPoints && !(seen.corner_error <= config_.points.max_error))
    return "where the points are, is not known well enough: their expected error is above points/max_error";
  if (task_ == Task::kParallel && !(seen.corner_error <= config_.parallel.max_error))
    return "where the view is, is not known well enough: its expected error is above parallel/max_error";
  if (repeats_.repeats())
    return "the picture repeats: the task error stays the same to the last digit while the scope moves";
  return "";
}

void Controller::Implementation::watchRepetition(const TaskErrorInput& task_error) {
  if (!task_error.problem.empty() || !task_error.valid || !task_error.image_time) return;
  const bool moves = moves_since_ && *task_error.image_time - *moves_since_ > servo_.delay() + kShows;
  repeats_.take(*task_error.image_time, task_error.error, moves && task_ != Task::kManual);
}

// Also of images in which nothing is tracked.
void Controller::Implementation::watchAge(const TaskErrorInput& seen, double time) {
  if (seen.image_time) usual_age_.take(*seen.image_time, time - seen.age);
}

// Whether picture and pose may be compared.
bool Controller::Implementation::isUsable(const ControllerInput& input) const {
  const TaskErrorInput& task = seen(input);
  return task_ != Task::kManual && task.problem.empty() && task.valid && task.image_time && implausible(task).empty() &&
         input.depth.problem.empty() && input.depth.d2 > 0.0;
}

// Images are observed also before engaging, so that the tissue's own motion is known by then.
void Controller::Implementation::watchEffect(const ControllerInput& input) {
  if (!isUsable(input)) return;
  const TaskErrorInput& task = seen(input);
  EffectObservation image;
  image.time = *task.image_time;
  image.error = task.error;
  image.region = task.region;
  image.scope = {input.depth.camera_R_shaft, d2(input)};
  image.desired_depth = config_.features.desired_depth;
  image.corner_error = task.corner_error;
  image.breath_known = servo_.breathingRate() > 0.0;
  if (task_ == Task::kParallel) {
    const std::optional<KeyedError> keyed = task.motion ? keyed_view_.see(image.time, *task.motion) : std::nullopt;
    if (!keyed) return;
    image.error = keyed->error;
    image.region = keyed->key;
    if (keyed->key_changed) image.in_last_region = keyed->last_key;
  }
  effect_.observe(image, servo_.history(), servo_.delay());
}

// It begins where somebody engages, or presses the dead-man switch, and looks; that of a hand anew wherever the scope
// stands.
void Controller::Implementation::watchLeash(const ControllerInput& input) {
  const bool waits_for_hand = task_ == Task::kCentreTip && told_.isZero(0.0);
  const bool goes_round = task_ == Task::kParallel && parallel_.stage() != ParallelStage::kTurn;
  if (machine_.state() == SafetyState::kArmed || !engaged() || task_ == Task::kManual || waits_for_hand || goes_round)
    leash_.restart();
  if (!isUsable(input) || goes_round) return;
  ServoInput servo = servoInput(input);
  if (task_ == Task::kParallel) servo.error = parallel_.goalError();
  const TaskErrorInput& task = seen(input);
  LeashObservation image{*task.image_time,         task.region, task.error,     servo_.toTarget(servo),
                         servo_.sinceImage(servo), true,        input.depth.d2, servo.insertion_point_T_tip};
  // Pan and then tilt turn the shaft about itself, too.
  image.has_orientation = task_ != Task::kParallel;
  // Without insertion the scope follows no depth.
  if (!servo_.use().insertion) image.d2 = image.to_target[3] = image.to_pose[3] = 0.0;
  leash_.observe(image);
}

void Controller::Implementation::watchTip(const TaskErrorInput& tip) {
  if (task_ != Task::kCentreTip || !told_.isZero(0.0) || !tip.problem.empty() || !tip.valid || !tip.image_time) {
    tip_.restart();
  } else {
    tip_.see(*tip.image_time, {tip.error.x, tip.error.y});
  }
}

}  // namespace laparoscope_servo::servo
