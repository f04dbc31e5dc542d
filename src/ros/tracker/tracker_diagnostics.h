// The diagnostics of the tracker.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <limits>
#include <mutex>
#include <string>

#include "ros/tracker/feed_statistics.h"
#include "ros/tracker/tracker_session.h"

namespace laparoscope_servo {

// Times are seconds of any steady clock.
class TrackerDiagnostics {
 public:
  explicit TrackerDiagnostics(const tracking::TrackerConfig& config, bool with_robot_motion = false,
                              bool with_external_mask = false)
      : config_(config), with_robot_motion_(with_robot_motion), with_external_mask_(with_external_mask) {}

  void processed(double now, const Processed& processed, bool ignores_distortion);
  // Takes the latency from the stamp of the last image to its result, s of ROS time.
  void answered(double now, double latency) { feed_.answered(now, latency); }
  // Call if an image could not be used.
  void refused(double now, const std::string& error, Refusal cause = Refusal::kData) {
    feed_.refused(now, error, cause);
  }
  // Call with the reason if an external mask was not accepted.
  void maskRefused(double now, const std::string& why);
  void setPublishers(const FeedPublishers& publishers) { feed_.setPublishers(publishers); }
  // Call with the reason if a view could not be recalled, or with an empty text. From any thread.
  void recallRefused(const std::string& why);

  // Level: OK while idle or tracking, WARN while searching, without images, without intrinsics, with several
  // publishers, or with an external mask that was refused, ERROR when lost or
  // when the newest image could not be used. Rate, mean and longest time are those since the last call, percentiles
  // those of the last minute.
  void fill(double now, diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  void summarise(double now, diagnostic_updater::DiagnosticStatusWrapper& status) const;
  std::string recall() const;
  std::string colourGate() const;
  std::string robotMotion() const;
  std::string externalMask() const;

  // Since the last call of fill().
  struct Window {
    int motion_wanted = 0;
    int motion_given = 0;
    int motion_used = 0;
    int images = 0;
    int mask_given = 0;
    int mask_predicted = 0;
  };

  tracking::TrackerConfig config_;
  bool with_robot_motion_;
  bool with_external_mask_;
  std::string motion_error_;
  Window window_;
  double mask_age_ = 0.0;    // s, of the last one used
  double mask_grown_ = 0.0;  // px
  double mask_share_ = 0.0;  // of the region
  std::string mask_refusal_;
  double mask_refused_at_ = -std::numeric_limits<double>::infinity();
  FeedStatistics feed_;
  std::string recall_ = "none";
  mutable std::mutex recall_mutex_;
  std::string recall_refusal_;  // of the newest request; empty if it was accepted
  std::string last_reset_;
  tracking::TrackResult result_;
  std::string camera_error_;
  bool selection_failed_ = false;
  bool has_camera_ = false;
  bool has_colour_ = true;
  bool ignores_distortion_ = false;
  bool rectifies_ = false;
};

}  // namespace laparoscope_servo
