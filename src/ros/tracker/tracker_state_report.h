// What the tracker publishes on ~state, and when: at once when state, region, size or view change; a reason whose
// numbers change with each image a few times a second; and once a second in any case, so that silence means something.
#pragma once

#include <laparoscope_servo/TrackerState.h>
#include <ros/time.h>

#include <optional>
#include <string>

#include "ros/tracker/tracker_session.h"

namespace laparoscope_servo {

// `now` is s of any steady clock. Each call returns the message to publish, if there is one.
class TrackerStateReport {
 public:
  std::optional<TrackerState> processed(double now, const Processed& processed);
  // An image came that could not be used. A single one among others changes nothing.
  void refused(const std::string& error) { refusal_ = error; }
  // To be called several times a second, also when no image comes.
  std::optional<TrackerState> tick(double now);

 private:
  std::optional<TrackerState> say(double now, bool at_once);

  TrackerState message_;
  std::string tracker_state_;  // of the newest image, also while none comes
  std::string tracker_reason_;
  std::string refusal_;  // of the newest image; empty: it was used
  double started_ = -1.0;
  double last_image_ = -1.0;
  double said_at_ = -1.0;
  std::string said_reason_;
};

// The message of a tracker that does not start.
TrackerState notStarted(const std::string& why);

}  // namespace laparoscope_servo
