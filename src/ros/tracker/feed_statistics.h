// What the diagnostics of every tracker say of its images: how many, how fast, how late, how many refused, and whose.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <array>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>

#include "ros/common/recent_values.h"
#include "ros/tracker/image_conversion.h"

namespace laparoscope_servo {

// Publishers of `image` and `camera_info`: how many, and whose messages are refused (empty: none).
struct FeedPublishers {
  unsigned images = 0;
  unsigned camera_infos = 0;
  std::string image_complaint;
  std::string camera_info_complaint;
};

// Times are seconds of any steady clock.
class FeedStatistics {
 public:
  // An image was processed, `period` s after the one before by their stamps, in `processing_time` s. `repeats`: its
  // picture is an earlier one.
  void processed(double now, double period, double processing_time, bool repeats);
  // Takes the latency from the stamp of the last image to its result, s of ROS time.
  void answered(double now, double latency);
  // An image could not be used.
  void refused(double now, const std::string& error, Refusal cause);
  void setPublishers(const FeedPublishers& publishers) { publishers_ = publishers; }

  // The summary while images do not come, or are refused; `before`: the state at the last one. False: they come.
  bool summariseMissing(double now, const std::string& before,
                        diagnostic_updater::DiagnosticStatusWrapper& status) const;
  // Merges a warning of several publishers into the summary.
  void warnOfPublishers(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  // Rate, mean and longest time are those since the last call, percentiles those of the last minute.
  void fill(double now, diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  void countDropped(double now, double period);
  void fillRecent(double now, diagnostic_updater::DiagnosticStatusWrapper& status);
  std::string refusals() const;

  struct Window {
    double start = 0.0;
    int images = 0;
    double total_time = 0.0;
    double longest_time = 0.0;
  };

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
  FeedPublishers publishers_;
  std::optional<double> last_image_;
  std::string refusal_;  // of the newest image; empty if it was used
  std::string last_refusal_;
};

}  // namespace laparoscope_servo
