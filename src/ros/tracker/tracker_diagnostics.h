// The diagnostics of the tracker.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <array>
#include <cstdint>
#include <iterator>
#include <mutex>
#include <optional>
#include <string>

#include "ros/common/recent_values.h"
#include "ros/tracker/image_conversion.h"
#include "ros/tracker/tracker_session.h"

namespace laparoscope_servo {

// Times are seconds of any steady clock.
class TrackerDiagnostics {
 public:
  explicit TrackerDiagnostics(const tracking::TrackerConfig& config, bool with_robot_motion = false)
      : config_(config), with_robot_motion_(with_robot_motion) {}

  void processed(double now, const Processed& processed, bool ignores_distortion);
  // Takes the latency from the stamp of the last image to its result, s of ROS time.
  void answered(double now, double latency);
  // Call if an image could not be used.
  void refused(double now, const std::string& error, Refusal cause = Refusal::kData);
  // Publishers of `image` and `camera_info`: how many, and whose messages are refused (empty: none).
  struct Publishers {
    unsigned images = 0;
    unsigned camera_infos = 0;
    std::string image_complaint;
    std::string camera_info_complaint;
  };
  void setPublishers(const Publishers& publishers) { publishers_ = publishers; }
  // Call with the reason if a view could not be recalled, or with an empty text. From any thread.
  void recallRefused(const std::string& why);

  // Level: OK while idle or tracking, WARN while searching, without images, without intrinsics, or with several
  // publishers, ERROR when lost or
  // when the newest image could not be used. Rate, mean and longest time are those since the last call, percentiles
  // those of the last minute.
  void fill(double now, diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  void summarise(double now, diagnostic_updater::DiagnosticStatusWrapper& status) const;
  std::string recall() const;
  std::string colourGate() const;
  std::string robotMotion() const;
  std::string refusals() const;
  void countDropped(double now, double period);
  void fillRecent(double now, diagnostic_updater::DiagnosticStatusWrapper& status);

  struct Window {
    double start = 0.0;
    int images = 0;
    double total_time = 0.0;
    double longest_time = 0.0;
    int motion_wanted = 0;
    int motion_given = 0;
    int motion_used = 0;
  };

  tracking::TrackerConfig config_;
  bool with_robot_motion_;
  std::string motion_error_;
  Window window_;
  std::uint64_t images_ = 0;
  std::array<std::uint64_t, std::size(kRefusals)> refused_{};  // by cause
  std::uint64_t repeated_ = 0;
  std::uint64_t dropped_ = 0;
  RecentValues recent_repeated_;  // 1 for each picture that repeats
  RecentValues recent_dropped_;   // number of images lost at each gap
  RecentValues latencies_;        // s
  RecentValues times_;            // s, processing time of an image
  RecentValues periods_{5.0};     // s, between stamps
  double usual_period_ = 0.0;     // s; 0: not known yet
  Publishers publishers_;
  std::optional<double> last_image_;
  std::string recall_ = "none";
  mutable std::mutex recall_mutex_;
  std::string recall_refusal_;  // of the newest request; empty if it was accepted
  std::string refusal_;         // of the newest image; empty if it was used
  std::string last_refusal_;
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
