// Measurements of the closed loop in the demo.
#pragma once

#include <laparoscope_servo/Homography.h>

#include <Eigen/Geometry>
#include <string>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo {

// Error of the ROI in the image relative to the reference image.
struct ViewError {
  double centre = 0.0;  // px
  double scale = 0.0;   // >= 0: relative, of the square root of the area
};

// Computed from g of the message, which must have the state TRACKING.
ViewError viewError(const Homography& message, const geometry::Rectangle& roi);

// Difference of the camera's pose from another one.
struct PoseError {
  double angle = 0.0;    // rad, between the optical axes
  double depth = 0.0;    // m, of d2, the distance from the insertion point; positive: deeper
  double lateral = 0.0;  // m, across the other pose's optical axis
};

// `insertion_point` in the base [m].
PoseError poseError(const Eigen::Isometry3d& base_T_reference, const Eigen::Isometry3d& base_T_camera,
                    const Eigen::Vector3d& insertion_point);

// Detects when the error has become small and stays so.
class Settling {
 public:
  // Inside means centre <= `centre` px and scale <= `scale`; settled when inside for `hold` s without a break.
  Settling(double centre, double scale, double hold) : centre_(centre), scale_(scale), hold_(hold) {}

  // At `time` s. `tracking` false counts as outside.
  void update(double time, bool tracking, const ViewError& error);
  bool settled() const { return settled_; }
  // s, when the error came inside for good; 0 while it is outside.
  double since() const { return inside_ ? since_ : 0.0; }

 private:
  double centre_;
  double scale_;
  double hold_;
  bool inside_ = false;
  bool settled_ = false;
  double since_ = 0.0;
};

// Contents of demo/summary.json.
struct DemoSummary {
  bool converged = false;
  std::string reason;              // why not; empty when converged
  int total_frames = 0;            // images processed since the ROI was selected
  int tracked_frames = 0;          // of these, in the state TRACKING
  double start_error_px = 0.0;     // when the loop was closed ...
  double start_scale_error = 0.0;  // relative
  PoseError start_truth;           // ... true pose error, by the emulator
  double settling_time = 0.0;      // s, from engaging until the error was inside the limits for good
  double final_error_px = 0.0;
  double final_scale_error = 0.0;          // relative
  PoseError final_truth;                   // true pose error, by the emulator
  bool crossed = false;                    // the instrument crossed while the loop was closed
  double crossing_visible_fraction = 1.0;  // least visible fraction, 0 to 1
  double crossing_error_px = 0.0;          // largest error of the tracked images
  int crossing_frames = 0;
  int crossing_tracked_frames = 0;
};

// As a JSON object; numbers that are not finite become null.
std::string toJson(const DemoSummary& summary);

}  // namespace laparoscope_servo
