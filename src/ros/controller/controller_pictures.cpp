// The messages by which tasks see the picture: one owner, one order of stamps, one form for all.
#include "ros/common/clocks.h"
#include "ros/controller/controller_conversions.h"
#include "ros/controller/controller_inputs.h"
#include "ros/controller/view_input.h"

namespace laparoscope_servo {

void ControllerInputs::Picture::forget() {
  last = servo::TaskErrorInput();
  last.problem = words.none;
  watch.clear();
}

// Whether the message is the owner's next one. `follows`: the present task goes by it.
template <typename Message>
bool ControllerInputs::takes(Input& input, Picture& picture, const ros::MessageEvent<Message const>& event,
                             bool follows) {
  if (!counts(input, event, engaged_ && follows)) return false;
  calls_.check_time();
  const ros::Time stamp = event.getConstMessage()->header.stamp;
  const StampGate::Verdict verdict = input.stamps.judge(stamp, ros::Time::now());
  if (verdict == StampGate::Verdict::kJumpedBack && follows) clock_jump_ = picture.words.jumped_back;
  if (verdict != StampGate::Verdict::kCounts && verdict != StampGate::Verdict::kJumpedBack) return false;
  picture.watch.arrived(stamp, steadyNow());
  return true;
}

// Converts the stamp to steady time once per image, since the clocks may drift.
void ControllerInputs::keep(Picture& picture, const servo::TaskErrorInput& seen) {
  const bool lost = picture.last.valid && !seen.valid;
  picture.last = seen;
  picture.last.image_time = steadyNow() - picture.watch.stampAge(ros::Time::now());
  if (engaged_ && lost) calls_.step();
}

void ControllerInputs::onTaskError(const ros::MessageEvent<TaskError const>& event) {
  const bool follows = task_ == servo::Task::kHoldView || task_ == servo::Task::kPosition;
  if (!takes(task_error_input_, task_error_, event, follows)) return;
  keep(task_error_, fromMessage(*event.getConstMessage()));
  position_input_.know(*event.getConstMessage());
}

// An image of another size has a task error, which is not valid, and no homography; an estimate that is no motion of a
// camera has both. The two topics may come in any order: one that is older than the homography says nothing.
bool ControllerInputs::isDenied(const Picture& position, const Picture& task_error) {
  return !task_error.watch.empty() && !task_error.last.valid && !position.watch.empty() &&
         task_error.watch.stamp() >= position.watch.stamp();
}

void ControllerInputs::onHomography(const ros::MessageEvent<Homography const>& event) {
  if (takes(homography_input_, position_, event, task_ == servo::Task::kPosition))
    keep(position_, position_input_.from(*event.getConstMessage(), calls_.depth()));
}

// The motion of the view, or of an object in it: one node tells both, by what was selected.
void ControllerInputs::onMotion(const ros::MessageEvent<TrackedFeatures const>& event) {
  const TrackedFeatures& message = *event.getConstMessage();
  Picture& picture = task_ == servo::Task::kFollow ? object_ : view_;
  Picture& other = task_ == servo::Task::kFollow ? view_ : object_;
  const bool follows =
      task_ == servo::Task::kStabilise || task_ == servo::Task::kFollow || task_ == servo::Task::kParallel;
  if (!takes(motion_input_, picture, event, follows)) return;
  other.watch.arrived(message.header.stamp, steadyNow());
  keep(view_, viewInput(message, camera_));
  keep(object_, object_place_.from(message, camera_));
}

void ControllerInputs::onPoints(const ros::MessageEvent<TrackedFeatures const>& event) {
  if (takes(points_input_, points_, event, task_ == servo::Task::kPoints))
    keep(points_, points_error_.from(*event.getConstMessage(), camera_, calls_.depth()));
}

// Another instrument is chosen only while nothing moves by this one.
void ControllerInputs::onInstrument(const ros::MessageEvent<TrackedFeatures const>& event) {
  const bool follows = task_ == servo::Task::kCentreTip;
  if (!takes(instrument_input_, tip_, event, follows)) return;
  if (!(engaged_ && follows)) tip_input_.release();
  keep(tip_, tip_input_.from(*event.getConstMessage(), camera_));
}

// Without a check of its stamp: a calibration does not grow old. With another one, what was measured by the last one
// does not go on.
void ControllerInputs::onCameraInfo(const ros::MessageEvent<sensor_msgs::CameraInfo const>& event) {
  const bool needs_none =
      task_ == servo::Task::kHoldView || task_ == servo::Task::kManual || task_ == servo::Task::kPosition;
  const bool matters = engaged_ && !needs_none;
  if (!counts(camera_info_input_, event, matters)) return;
  if (camera_.take(*event.getConstMessage()) && matters) end("camera_info has another calibration");
}

}  // namespace laparoscope_servo
