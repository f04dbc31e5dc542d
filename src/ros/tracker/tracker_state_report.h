// Messages on ~state: at once if state, region, size or view change; a few times a second if only the reason changes;
// and once a second in any case, so that silence is a sign of failure.
#pragma once

#include <laparoscope_servo/TrackerState.h>
#include <ros/time.h>

#include <optional>
#include <string>

#include "ros/tracker/tracker_session.h"

namespace laparoscope_servo {

// `now`: s of any steady clock. Each call returns the message to publish, if there is one.
class TrackerStateReport {
 public:
  std::optional<TrackerState> processed(double now, const Processed& processed);
  // Call if an image could not be used. A single one among others has no effect.
  void refused(double now, const std::string& error) { refusal_ = error, refused_at_ = now; }
  // Call several times a second, also without images.
  std::optional<TrackerState> tick(double now);

 private:
  std::optional<TrackerState> say(double now, bool at_once);

  TrackerState message_;
  std::string tracker_state_;  // state at the newest image, also while none comes
  std::string tracker_reason_;
  std::string refusal_;  // why the newest image was refused; empty: it was used
  double refused_at_ = -1.0;
  double started_ = -1.0;
  double last_image_ = -1.0;
  double said_at_ = -1.0;
  std::string said_reason_;
};

// The message of a tracker that does not start.
TrackerState notStarted(const std::string& why);

}  // namespace laparoscope_servo
